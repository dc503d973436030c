#include "mesh/quadrature.hpp"

#include <gtest/gtest.h>

#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {
namespace {

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// Largest error over the monomials xi^a eta^b zeta^c of degree `degree`: exact is
/// a! b! c! / (a + b + c + 3)!.
template <class Rule>
double error_at_degree(const Rule& rule, int degree) {
  double worst = 0;
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; a + b <= degree; ++b) {
      const int c = degree - a - b;
      double sum = 0;
      for (const auto& q : rule)
        sum += q.weight * std::pow(q.xi[0], a) * std::pow(q.xi[1], b) * std::pow(q.xi[2], c);
      const double exact = factorial(a) * factorial(b) * factorial(c) / factorial(degree + 3);
      worst = std::max(worst, std::abs(sum - exact));
    }
  return worst;
}

struct RuleCase {
  int points, degree;
};

class Quadrature : public ::testing::TestWithParam<RuleCase> {};

TEST_P(Quadrature, IsExactToItsDegreeOnlyWithPositiveWeightsInside) {
  const auto [points, degree] = GetParam();
  const auto rule = tet_quadrature(points);
  ASSERT_EQ(static_cast<int>(rule.size()), points);
  for (int d = 0; d <= degree; ++d) EXPECT_LT(error_at_degree(rule, d), 1e-16) << d;
  EXPECT_GT(error_at_degree(rule, degree + 1), 1e-8);
  for (const auto& q : rule) {
    EXPECT_GT(q.weight, 1e-3);
    EXPECT_GE(q.xi.minCoeff(), 0);
    EXPECT_LE(q.xi.sum(), 1 + 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, Quadrature,
                         ::testing::Values(RuleCase{4, 2}, RuleCase{8, 3}, RuleCase{14, 5},
                                           RuleCase{15, 5}));

TEST(QuadratureRules, AreThoseThatAreListed) {
  for (int points : tet_quadrature_sizes)
    EXPECT_EQ(static_cast<int>(tet_quadrature(points).size()), points);
  EXPECT_THROW(tet_quadrature(5), core::InternalError);
}

/// Keast's rule as it is tabulated, and in the programs ours is compared with.
TEST(QuadratureRules, FifteenPointsBeginAtTheCentroid) {
  const auto first = tet_quadrature_15()[0];
  EXPECT_LT((first.xi - core::Vec3::Constant(0.25)).norm(), 1e-16);
  EXPECT_NEAR(first.weight, 0.030283678097089, 1e-15);
}

TEST(ShapeFunctions, AreOneAtTheirNodeAndZeroAtTheOthers) {
  std::array<core::Vec3, 10> nodes;
  nodes[0] = core::Vec3::Zero();
  for (int i = 0; i < 3; ++i) nodes[1 + i] = core::Vec3::Unit(i);
  for (int e = 0; e < 6; ++e)
    nodes[4 + e] = (nodes[tetrahedron_edges[e][0]] + nodes[tetrahedron_edges[e][1]]) / 2;
  for (int i = 0; i < 10; ++i) {
    const auto n = tet10_shape(nodes[i]);
    for (int j = 0; j < 10; ++j) EXPECT_EQ(n[j], i == j ? 1.0 : 0.0);
  }
  const double tri[6][2] = {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}};
  for (int i = 0; i < 6; ++i) {
    const auto n = tri6_shape(tri[i][0], tri[i][1]);
    for (int j = 0; j < 6; ++j) EXPECT_EQ(n[j], i == j ? 1.0 : 0.0);
  }
}

TEST(ShapeFunctions, GradientsAreThoseOfTheValues) {
  const core::Vec3 x(0.13, 0.31, 0.22);
  const double h = 1e-6;
  const auto g = tet10_gradients(x);
  for (int d = 0; d < 3; ++d) {
    const auto p = tet10_shape(x + h * core::Vec3::Unit(d));
    const auto m = tet10_shape(x - h * core::Vec3::Unit(d));
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(g[i][d], (p[i] - m[i]) / (2 * h), 1e-9);
  }
  const auto t = tri6_gradients(0.2, 0.3);
  for (int d = 0; d < 2; ++d) {
    const auto p = tri6_shape(0.2 + (d == 0) * h, 0.3 + (d == 1) * h);
    const auto m = tri6_shape(0.2 - (d == 0) * h, 0.3 - (d == 1) * h);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(t[i][d], (p[i] - m[i]) / (2 * h), 1e-9);
  }
}

TEST(ShapeFunctions, JacobianOfTheUnitTetrahedronIsTheIdentity) {
  std::array<core::Vec3, 10> x;
  x[0] = core::Vec3::Zero();
  for (int i = 0; i < 3; ++i) x[1 + i] = core::Vec3::Unit(i);
  for (int e = 0; e < 6; ++e)
    x[4 + e] = (x[tetrahedron_edges[e][0]] + x[tetrahedron_edges[e][1]]) / 2;
  for (const auto& q : tet_quadrature_4())
    EXPECT_LT((tet10_jacobian(x, tet10_gradients(q.xi)) - core::Mat3::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace polyslip::mesh
