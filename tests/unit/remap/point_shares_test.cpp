#include "remap/point_shares.hpp"

#include <gtest/gtest.h>

namespace polyslip::remap {
namespace {

using core::Vec3;

/// Of four points each has the part where its corner's barycentric coordinate is the largest, whose
/// mean there is (1 + 1/2 + 1/3 + 1/4)/4.
TEST(PointShares, OfFourPointsAreQuarters) {
  const auto rule = mesh::tet_quadrature(4);
  const auto centroids = share_centroids(rule);
  ASSERT_EQ(centroids.size(), 4u);
  for (std::size_t q = 0; q < 4; ++q) {
    const auto barycentric = [](const Vec3& xi) {
      return std::array<double, 4>{1 - xi.sum(), xi[0], xi[1], xi[2]};
    };
    const auto point = barycentric(rule[q].xi), centroid = barycentric(centroids[q]);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(centroid[i], point[i] > 0.25 ? 25.0 / 48 : 23.0 / 144, 1e-3);
  }
}

/// So that transport onto the same mesh changes nothing.
TEST(PointShares, HoldTheirCentroids) {
  for (const int points : {4, 8, 14, 15}) {
    const auto rule = mesh::tet_quadrature(points);
    const auto centroids = share_centroids(rule);
    for (std::size_t q = 0; q < rule.size(); ++q) {
      EXPECT_EQ(nearest_point(rule, centroids[q]), q) << points;
      EXPECT_EQ(nearest_point(rule, rule[q].xi), q) << points;
      EXPECT_GT(centroids[q].minCoeff(), 0);
      EXPECT_LT(centroids[q].sum(), 1);
    }
  }
}

/// All corners alike: a face's two nearest points have the same distance from its middle.
TEST(PointShares, SetNoCornerApart) {
  const auto rule = mesh::tet_quadrature(4);
  const double a = 0.5, b = 0.3, c = 0.1;
  std::array<std::size_t, 4> nearest{nearest_point(rule, {b, c, c}), nearest_point(rule, {a, b, c}),
                                     nearest_point(rule, {c, a, b}),
                                     nearest_point(rule, {b, c, a})};
  for (std::size_t q = 0; q < 4; ++q) EXPECT_EQ(nearest[q], q);
}

}  // namespace
}  // namespace polyslip::remap
