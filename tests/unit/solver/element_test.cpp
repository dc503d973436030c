#include "solver/element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "mesh/mesh.hpp"
#include "mesh/quadrature.hpp"
#include "support/elastic_law.hpp"

namespace polyslip::solver {
namespace {

/// Values in [-1, 1] from a small generator.
class Noise {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1;
  }

 private:
  std::uint64_t state_ = 12345;
};

ElementPositions curved_element(double amount) {
  ElementPositions x{};
  const double corners[4][3] = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {0.1, 0.2, 0.9}};
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i) x[a][i] = corners[a][i];
  for (int e = 0; e < 6; ++e)
    for (int i = 0; i < 3; ++i)
      x[4 + e][i] =
          0.5 * (x[mesh::tetrahedron_edges[e][0]][i] + x[mesh::tetrahedron_edges[e][1]][i]);
  Noise noise;
  for (auto& node : x)
    for (double& c : node) c += amount * noise();
  return x;
}

/// An element of the test law between two configurations.
struct Evaluated {
  ElementGeometry geometry;
  std::array<double, 6 * max_element_slots> stress{}, state{}, state_old{};
  std::array<double, 54 * max_element_slots> tangent{};
  std::array<double, max_element_slots> mean_stress{};
  ElementForces forces{};
};

Evaluated evaluate(const PointRule& rule, const ElementPositions& x_old, const ElementPositions& x,
                   double mean_stress, double bulk) {
  Evaluated e;
  const tests::ElasticLaw law(30.0, 100.0);
  std::array<double, 9 * max_element_slots> f{};
  std::array<material::PointStatus, max_element_slots> status{};
  EXPECT_TRUE(element_geometry(rule, x, e.geometry));
  EXPECT_TRUE(relative_gradients(x_old, x, e.geometry, f.data()));
  material::PointBlocks b;
  b.n_blocks = rule.blocks;
  b.relative_gradient = f.data();
  b.state_old = e.state_old.data();
  b.state_new = e.state.data();
  b.stress = e.stress.data();
  b.tangent = e.tangent.data();
  b.status = status.data();
  law.update(b);
  ElementGeometry before;
  EXPECT_TRUE(element_geometry(rule, x_old, before));
  for (int q = 0; q < rule.points; ++q)
    e.mean_stress[q] = mean_stress + bulk * std::log(e.geometry.weights[q] / before.weights[q]);
  element_forces(e.geometry, e.stress.data(), e.mean_stress.data(), e.forces);
  return e;
}

void expect_tangent_of_forces(const PointRule& rule, double bulk) {
  const ElementPositions x_old = curved_element(0.02), x = curved_element(0.05);
  const Evaluated here = evaluate(rule, x_old, x, 7.0, bulk);
  ElementMatrix K;
  element_tangent(here.geometry, here.stress.data(), here.tangent.data(), here.mean_stress.data(),
                  bulk, K);
  const double h = 1e-6;
  double largest = 0;
  for (int b = 0; b < 10; ++b)
    for (int k = 0; k < 3; ++k) {
      ElementPositions up = x, down = x;
      up[b][k] += h;
      down[b][k] -= h;
      const auto above = evaluate(rule, x_old, up, 7.0, bulk),
                 below = evaluate(rule, x_old, down, 7.0, bulk);
      for (int a = 0; a < 10; ++a)
        for (int i = 0; i < 3; ++i) {
          const double difference = (above.forces[a][i] - below.forces[a][i]) / (2 * h);
          EXPECT_NEAR(K[a][i][b][k], difference, 1e-6) << a << i << b << k;
          largest = std::max(largest, std::abs(difference));
        }
    }
  EXPECT_GT(largest, 1.0);
}

class Element : public ::testing::TestWithParam<int> {
 protected:
  const PointRule& rule() const { return point_rule(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Points, Element, ::testing::ValuesIn(mesh::tet_quadrature_sizes));

TEST_P(Element, TangentMatchesDifferencesAtConstantMeanStress) {
  expect_tangent_of_forces(rule(), 0);
}
TEST_P(Element, TangentMatchesDifferencesOfTheDisplacementElement) {
  expect_tangent_of_forces(rule(), 80);
}

/// Forces and volumes are then those of the corners' tetrahedron for every position of mid nodes,
/// but mid nodes still carry displacements: all of that up to first order in the curvature.
TEST_P(Element, StraightGeometryIsThatOfTheCorners) {
  const PointRule& straight = point_rule(GetParam(), true);
  ElementPositions x = curved_element(0.05), corners = x;
  for (int e = 0; e < 6; ++e)
    for (int i = 0; i < 3; ++i)
      corners[4 + e][i] =
          0.5 * (x[mesh::tetrahedron_edges[e][0]][i] + x[mesh::tetrahedron_edges[e][1]][i]);
  ElementGeometry ours, theirs;
  ASSERT_TRUE(element_geometry(straight, x, ours) && element_geometry(rule(), corners, theirs));
  EXPECT_NEAR(ours.volume, theirs.volume, 1e-15);
  EXPECT_NEAR(ours.min_jacobian_ratio, 1, 1e-14);
  for (int q = 0; q < rule().points; ++q)
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 10; ++a)
        EXPECT_NEAR(ours.gradients[q][i][a], theirs.gradients[q][i][a], 1e-13);
  // A rigid translation is none, whatever the curvature.
  ElementPositions moved = x;
  for (auto& node : moved) node[1] += 0.2;
  std::array<double, 9 * max_element_slots> f{};
  ASSERT_TRUE(element_geometry(straight, moved, ours));
  ASSERT_TRUE(relative_gradients(x, moved, ours, f.data()));
  for (int slot = 0; slot < rule().slots; ++slot)
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(f[PointRule::at(9, k, slot)], k % 4 == 0 ? 1 : 0, 1e-14);
}

TEST_P(Element, VolumeGradientMatchesDifferences) {
  const ElementPositions x = curved_element(0.05);
  ElementGeometry g;
  ASSERT_TRUE(element_geometry(rule(), x, g));
  EXPECT_GT(g.volume, 0.1);
  EXPECT_GT(g.min_jacobian_ratio, 0);
  EXPECT_LT(g.min_jacobian_ratio, 1);
  ElementForces b;
  element_volume_gradient(g, b);
  for (int a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i) {
      ElementPositions up = x, down = x;
      up[a][i] += 1e-6;
      down[a][i] -= 1e-6;
      ElementGeometry above, below;
      ASSERT_TRUE(element_geometry(rule(), up, above) && element_geometry(rule(), down, below));
      EXPECT_NEAR(b[a][i], (above.volume - below.volume) / 2e-6, 1e-8);
    }
}

TEST_P(Element, RelativeGradientIsThatOfALinearMotion) {
  const ElementPositions x_old = curved_element(0.03);
  const double F[3][3] = {{1.1, 0.2, 0}, {-0.1, 0.9, 0.05}, {0.02, 0, 1.03}};
  ElementPositions x{};
  for (int a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) x[a][i] += F[i][j] * x_old[a][j];
  ElementGeometry g;
  ASSERT_TRUE(element_geometry(rule(), x, g));
  std::array<double, 9 * max_element_slots> f{};
  ASSERT_TRUE(relative_gradients(x_old, x, g, f.data()));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int slot = 0; slot < rule().slots; ++slot)
        EXPECT_NEAR(f[PointRule::at(9, 3 * i + j, slot)], F[i][j], 1e-13) << slot;
}

TEST_P(Element, AnInvertedOrNanElementIsRefused) {
  ElementPositions x = curved_element(0.0);
  ElementGeometry g;
  for (auto& node : x) node[2] = -node[2];
  EXPECT_FALSE(element_geometry(rule(), x, g));
  x = curved_element(0.0);
  x[3][2] = std::nan("");
  EXPECT_FALSE(element_geometry(rule(), x, g));
}

TEST_P(Element, ShearModulusIsTheLaws) {
  const ElementPositions x = curved_element(0.02);
  const Evaluated e = evaluate(rule(), x, x, 0, 0);
  EXPECT_NEAR(element_shear_modulus(e.geometry, e.tangent.data()), 30.0, 1e-10);
}

}  // namespace
}  // namespace polyslip::solver
