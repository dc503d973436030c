#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "core/error.hpp"
#include "mesh/mesh.hpp"
#include "two_tetrahedra.hpp"

namespace polyslip::mesh {
namespace {

TEST(MeshCheck, AcceptsTwoTetrahedraOfTwoGrains) { EXPECT_NO_THROW(check(two_tetrahedra())); }

TEST(MeshCheck, AcceptsOrderOne) {
  Mesh m = two_tetrahedra();
  m.order = 1;
  m.nodes.resize(5);
  for (auto& t : m.tetrahedra) std::fill(t.begin() + 4, t.end(), -1);
  for (auto& t : m.triangles) std::fill(t.begin() + 3, t.end(), -1);
  for (auto& l : m.lines) l[2] = -1;
  EXPECT_NO_THROW(check(m));
  m.lines[0][2] = 3;
  EXPECT_THROW(check(m), core::InternalError);
}

TEST(MeshCheck, RejectsEachBrokenInvariant) {
  const std::vector<std::pair<const char*, std::function<void(Mesh&)>>> damages{
      {"empty", [](Mesh& m) { m = Mesh{}; }},
      {"NaN", [](Mesh& m) { m.nodes[7][1] = std::nan(""); }},
      {"unused node",
       [](Mesh& m) {
         m.nodes.push_back({0, 0, 0});
       }},
      {"node out of range", [](Mesh& m) { m.tetrahedra[0][2] = 99; }},
      {"unsorted grains", [](Mesh& m) { std::swap(m.tetrahedron_cell[0], m.tetrahedron_cell[1]); }},
      {"tag out of range", [](Mesh& m) { m.triangle_face.back() = 7; }},
      {"missing triangle", [](Mesh& m) { m.triangles.pop_back(), m.triangle_face.pop_back(); }},
      {"face without triangle", [](Mesh& m) { m.topology.faces.push_back(m.topology.faces[0]); }},
      {"wrong face", [](Mesh& m) { std::swap(m.triangles[0], m.triangles[1]); }},
      {"triangle turned",
       [](Mesh& m) {
         std::swap(m.triangles[2][1], m.triangles[2][2]);
         std::swap(m.triangles[2][3], m.triangles[2][5]);
       }},
      {"mid nodes of a triangle swapped",
       [](Mesh& m) { std::swap(m.triangles[0][3], m.triangles[0][4]); }},
      {"mid nodes of a tetrahedron swapped",
       [](Mesh& m) { std::swap(m.tetrahedra[0][4], m.tetrahedra[0][5]); }},
      {"another mid node",
       [](Mesh& m) {
         m.nodes.push_back(m.nodes[m.tetrahedra[1][4]]);
         m.tetrahedra[1][4] = m.node_count() - 1;
       }},
      {"line turned", [](Mesh& m) { std::swap(m.lines[0][0], m.lines[0][1]); }},
      {"vertex elsewhere", [](Mesh& m) { m.vertex_nodes[0] = 1; }},
      {"inverted",
       [](Mesh& m) {
         m.nodes[3] = {0.1, 0.1, -0.1};
       }},
      {"flat",
       [](Mesh& m) {
         m.nodes[3] = {0.1, 0.1, 0};
       }},
      {"curved beyond positive", [](Mesh& m) { m.nodes[m.tetrahedra[0][7]][2] = 0.9; }},
      {"same side",
       [](Mesh& m) {
         m.nodes[4] = {0.2, 0.2, 1};
         std::swap(m.tetrahedra[1][0], m.tetrahedra[1][1]);
         std::swap(m.tetrahedra[1][5], m.tetrahedra[1][6]);
         std::swap(m.tetrahedra[1][7], m.tetrahedra[1][9]);
       }},
  };
  for (const auto& [what, damage] : damages) {
    Mesh m = two_tetrahedra();
    damage(m);
    std::string why;
    for (const int threads : {1, 3}) try {
        check(m, threads);
        ADD_FAILURE() << what;
      } catch (const core::InternalError& error) {
        if (why.empty()) why = error.what();
        EXPECT_EQ(why, error.what());
      }
  }
}

TEST(MeshQuality, VolumesAreExactForCurvedElements) {
  Mesh m = two_tetrahedra();
  EXPECT_NEAR(element_volume(m, 0), 1.0 / 6, 1e-16);
  // A quadratic map x = X + a (Y^2, YZ, 0): det = 1 + a Z dY... has volume equal to the integral of
  // det J, here of 1 + a z over the unit tetrahedron: 1/6 + a/24.
  const double a = 0.2;
  for (auto& x : m.nodes) x += a * core::Vec3(x[1] * x[1], x[1] * x[2], 0);
  EXPECT_NEAR(element_volume(m, 0), 1.0 / 6 + a / 24, 1e-15);
  const auto volumes = grain_volumes(m);
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_EQ(volumes[0], element_volume(m, 0));
  EXPECT_EQ(volumes[1], element_volume(m, 1));
}

TEST(MeshQuality, RadiusRatioIsOneForTheRegularTetrahedron) {
  const core::Vec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  EXPECT_NEAR(std::abs(radius_ratio(a, b, c, d)), 1, 1e-15);
  // Corner of a cube: r = 1/(3 + sqrt 3), R = sqrt(3)/2.
  const core::Vec3 o = core::Vec3::Zero();
  const double corner = 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2);
  EXPECT_NEAR(radius_ratio(o, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), corner, 1e-15);
  EXPECT_EQ(radius_ratio(o, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
}

TEST(MeshQuality, SummaryHoldsTheWorstAndTheMean) {
  const Mesh m = two_tetrahedra();
  const auto& x = m.nodes;
  const double r0 = radius_ratio(x[0], x[1], x[2], x[3]), r1 = radius_ratio(x[0], x[2], x[1], x[4]);
  EXPECT_EQ(quality(m).min_radius_ratio, std::min(r0, r1));
  EXPECT_NEAR(quality(m).mean_radius_ratio, (r0 + r1) / 2, 1e-15);
  Mesh broken = m;
  broken.nodes[3][0] = std::nan("");  // of the first tetrahedron only
  EXPECT_TRUE(std::isnan(quality(broken).min_radius_ratio));
  EXPECT_TRUE(std::isnan(quality(broken).mean_radius_ratio));
}

TEST(MshFile, HoldsEveryNodeBitForBitAndTheElementsInOrder) {
  Mesh m = two_tetrahedra();
  m.nodes[4] = {1.0 / 3, 0.1, -2.0 / 7};
  const std::string path =
      (std::filesystem::temp_directory_path() / "polyslip_msh_file_test.msh").string();
  write_msh(m, path);
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  std::filesystem::remove(path);
  std::string word;
  while (text >> word && word != "$Nodes") {
  }
  int count = 0;
  text >> count;
  ASSERT_EQ(count, m.node_count());
  for (int i = 0; i < count; ++i) {
    int id = 0;
    core::Vec3 x;
    text >> id >> x[0] >> x[1] >> x[2];
    EXPECT_EQ(id, i + 1);
    EXPECT_EQ(x, m.nodes[i]);
  }
  text >> word >> word >> count;
  ASSERT_EQ(count, 2 + 6);
  for (int e = 0; e < 2; ++e) {
    int id = 0, type = 0, tags = 0, physical = 0, elementary = 0;
    text >> id >> type >> tags >> physical >> elementary;
    EXPECT_EQ(id, e + 1);
    EXPECT_EQ(type, 11);
    EXPECT_EQ(physical, e + 1);
    for (int n : m.tetrahedra[e]) {
      int node = 0;
      text >> node;
      EXPECT_EQ(node, n + 1);
    }
  }
  EXPECT_THROW(write_msh(m, "/nonexistent/folder/a.msh"), core::InputError);
}

}  // namespace
}  // namespace polyslip::mesh
