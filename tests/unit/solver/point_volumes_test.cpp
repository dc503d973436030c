#include "solver/point_volumes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "mesh/mesh.hpp"
#include "mesh/quadrature.hpp"

namespace polyslip::solver {
namespace {

ElementPositions reference_positions() {
  ElementPositions x{{{0, 0, 0}, {1.1, 0.1, 0}, {0.1, 0.9, 0.1}, {0, 0.1, 1}}};
  for (int e = 0; e < 6; ++e)
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = mesh::tetrahedron_edges[e];
      x[4 + e][i] = (x[a][i] + x[b][i]) / 2;
    }
  return x;
}

ElementPositions moved(ElementPositions x, double amount) {
  core::Random random(3, core::Stream::tests);
  for (auto& node : x)
    for (double& c : node) c += amount * random.uniform(-1, 1);
  return x;
}

/// The resistance and its forces at positions x, for a body whose points had their volumes at x0.
struct Response {
  PointVolumeResistance resistance;
  std::array<double, max_element_slots> p{};
  ElementGeometry geometry;
  ElementForces forces{};
};

Response response(const PointRule& rule, const ElementPositions& x0, const ElementPositions& x,
                  double kappa) {
  ElementGeometry before;
  Response r;
  EXPECT_TRUE(element_geometry(rule, x0, before));
  EXPECT_TRUE(element_geometry(rule, x, r.geometry));
  std::array<double, max_element_points> ratio{};
  for (int q = 0; q < rule.points; ++q) ratio[q] = r.geometry.weights[q] / before.weights[q];
  r.resistance = point_volume_resistance(r.geometry, ratio.data(), kappa);
  r.p = resistance_mean_stress(r.resistance, r.geometry);
  const std::array<double, 6 * max_element_slots> no_stress{};
  element_forces(r.geometry, no_stress.data(), r.p.data(), r.forces);
  return r;
}

double energy(const PointVolumeResistance& resistance) {
  double u = 0;
  for (int q = 0; q < max_element_slots; ++q)
    u += resistance.kappa / 2 * resistance.reference[q] * resistance.s[q] * resistance.s[q];
  return u;
}

class PointVolumes : public ::testing::TestWithParam<int> {
 protected:
  const PointRule& rule() const { return point_rule(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Points, PointVolumes, ::testing::ValuesIn(mesh::tet_quadrature_sizes));

TEST_P(PointVolumes, AreFreeOfStressWhereAllPointsGrowAlike) {
  const ElementPositions x0 = reference_positions();
  ElementPositions x = x0;
  for (auto& node : x)
    for (double& c : node) c *= 1.1;
  for (double p : response(rule(), x0, x, 500).p) EXPECT_NEAR(p, 0, 1e-11);
}

TEST(PointVolumeModulus, IsAViscosityOverTheStepWithALimit) {
  EXPECT_NEAR(point_volume_modulus(27, 0.02, 27e3), 4 * 27 / 0.06, 1e-9);
  EXPECT_NEAR(point_volume_modulus(27, 0.04, 27e3), 4 * 27 / 0.12, 1e-9);
  EXPECT_NEAR(point_volume_modulus(27, 1e-4, 27e3), 4 * 27 / 3e-4, 1e-9);
  EXPECT_NEAR(point_volume_modulus(27, 1e-5, 27e3), 20 * 27e3, 1e-9);
  EXPECT_EQ(point_volume_modulus(0, 1e-4, 27e3), 0);
}

TEST_P(PointVolumes, AddNoMeanStressToTheElement) {
  const Response r =
      response(rule(), reference_positions(), moved(reference_positions(), 0.05), 500);
  double mean = 0, size = 0;
  for (int q = 0; q < r.geometry.points; ++q) {
    mean += r.geometry.weights[q] * r.p[q];
    size += std::abs(r.p[q]);
  }
  EXPECT_NEAR(mean, 0, 1e-12);
  EXPECT_GT(size, 10);
}

TEST_P(PointVolumes, ForcesAreTheDerivativeOfTheEnergy) {
  const ElementPositions x0 = reference_positions(), x = moved(x0, 0.05);
  const Response r = response(rule(), x0, x, 500);
  constexpr double step = 1e-6;
  for (int a = 0; a < element_nodes; ++a)
    for (int i = 0; i < 3; ++i) {
      ElementPositions plus = x, minus = x;
      plus[a][i] += step;
      minus[a][i] -= step;
      const double slope = (energy(response(rule(), x0, plus, 500).resistance) -
                            energy(response(rule(), x0, minus, 500).resistance)) /
                           (2 * step);
      EXPECT_NEAR(r.forces[a][i], slope, 1e-6);
    }
}

TEST_P(PointVolumes, TangentIsTheDerivativeOfTheForces) {
  const ElementPositions x0 = reference_positions(), x = moved(x0, 0.05);
  const Response r = response(rule(), x0, x, 500);
  ElementMatrix matrix;
  const std::array<double, 6 * max_element_slots> no_stress{};
  const std::array<double, 54 * max_element_slots> no_tangent{};
  element_tangent(r.geometry, no_stress.data(), no_tangent.data(), r.p.data(), 0, matrix);
  add_resistance_tangent(r.resistance, r.geometry, matrix);
  constexpr double step = 1e-6;
  for (int b = 0; b < element_nodes; ++b)
    for (int k = 0; k < 3; ++k) {
      ElementPositions plus = x, minus = x;
      plus[b][k] += step;
      minus[b][k] -= step;
      const Response up = response(rule(), x0, plus, 500), down = response(rule(), x0, minus, 500);
      for (int a = 0; a < element_nodes; ++a)
        for (int i = 0; i < 3; ++i)
          EXPECT_NEAR(matrix[a][i][b][k], (up.forces[a][i] - down.forces[a][i]) / (2 * step), 1e-5);
    }
}

}  // namespace
}  // namespace polyslip::solver
