#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

/// Regular octahedron about a middle node: 8 tetrahedra.
struct Octahedron {
  SurfaceMesh surface;
  VolumeMesh volume;
  Octahedron() {
    surface.nodes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    volume.nodes = surface.nodes;
    volume.nodes.emplace_back(0, 0, 0);
    for (const auto& t : surface.triangles) volume.tetrahedra.push_back({6, t[0], t[1], t[2]});
  }
};

TEST(RadiusRatio, KnownTetrahedra) {
  const core::Vec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  EXPECT_NEAR(radius_ratio(a, b, c, d), -1, 1e-14);  // this order is negative
  EXPECT_NEAR(radius_ratio(b, a, c, d), 1, 1e-14);
  // Corner of a cube: r = (3 - sqrt 3) / 6, R = sqrt 3 / 2.
  const core::Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_NEAR(radius_ratio(o, x, y, z), std::sqrt(3.0) - 1, 1e-14);
  EXPECT_NEAR(radius_ratio(y, z, o, x), radius_ratio(o, x, y, z), 1e-14);
  EXPECT_EQ(radius_ratio(o, x, y, core::Vec3(1, 1, 0)), 0);
  EXPECT_EQ(radius_ratio(o, o, o, o), 0);
}

TEST(Validate, TakesAGoodMesh) {
  const Octahedron o;
  EXPECT_EQ(validate(o.surface, o.volume), "");
}

TEST(Validate, NamesEachFault) {
  const auto fault = [](auto&& change) {
    Octahedron o;
    change(o);
    return validate(o.surface, o.volume);
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.surface = {}; }), "surface is empty"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume = {}; }), "no tetrahedra"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.nodes.resize(3); }), "missing"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.nodes[1].x() += 1e-15; }), "moved"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.nodes[6].x() = nan; }), "not finite"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.surface.nodes[6 - 1].x() = nan; }), "not finite"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.tetrahedra[2][1] = 7; }), "node 7 of 7"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.tetrahedra[2][1] = -1; }), "node -1"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.nodes.emplace_back(0, 0, 0); }), "unused"));
  EXPECT_TRUE(
      has(fault([](Octahedron& o) { o.volume.tetrahedra.pop_back(); }), "not kept: 7 of 8"));
  EXPECT_TRUE(has(fault([](Octahedron& o) {
                    for (auto& t : o.surface.triangles) std::swap(t[0], t[1]);
                  }),
                  "not kept: 0 of 8"));
  EXPECT_TRUE(has(
      fault([](Octahedron& o) { std::swap(o.volume.tetrahedra[1][0], o.volume.tetrahedra[1][1]); }),
      "one side"));
  EXPECT_TRUE(
      has(fault([](Octahedron& o) { o.volume.tetrahedra.push_back(o.volume.tetrahedra[0]); }),
          "tetrahedra"));
  EXPECT_TRUE(has(fault([](Octahedron& o) { o.volume.nodes[6].x() = 1.5; }), "has volume"));
  EXPECT_TRUE(
      has(fault([](Octahedron& o) { o.volume.nodes[6].x() = 0, o.volume.nodes[6].z() = 1; }),
          "has volume"));
}

TEST(QualityO, FollowsTheEquations) {
  const Octahedron o;
  // Eight equal corners of a cube: rho = sqrt 3 - 1, edges 1 and sqrt 2, three each.
  const double rho = std::sqrt(3.0) - 1, length = (1 + std::sqrt(2.0)) / 2;
  const double power = std::pow(rho, 0.1);
  const double sigma = std::pow(rho, std::exp(power / (power - 1)));
  for (const double size : {0.5, 1.2, 3.0}) {
    const double v = std::min(length / size, size / length);
    const double expected = std::pow(std::pow(sigma, 8), 0.8) * std::pow(v * v * v, 0.2);
    EXPECT_NEAR(mesh_quality_O(o.volume, size), expected, 1e-14);
  }
  EXPECT_NEAR(min_radius_ratio(o.volume), rho, 1e-14);
}

TEST(QualityO, EndsOfTheScale) {
  VolumeMesh regular{{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}, {{0, 2, 1, 3}}};
  const double edge = std::sqrt(8.0);
  std::swap(regular.tetrahedra[0][0], regular.tetrahedra[0][1]);
  EXPECT_NEAR(mesh_quality_O(regular, edge), 1, 1e-12);
  std::swap(regular.tetrahedra[0][0], regular.tetrahedra[0][1]);
  EXPECT_EQ(mesh_quality_O(regular, edge), 0);
  regular.nodes[0].x() = nan;
  EXPECT_EQ(mesh_quality_O(regular, edge), 0);
  EXPECT_TRUE(std::isnan(min_radius_ratio(regular)));
  EXPECT_EQ(mesh_quality_O(VolumeMesh{}, 1), 0);
  EXPECT_EQ(min_radius_ratio(VolumeMesh{}), 0);
}

}  // namespace
}  // namespace polyslip::mesh
