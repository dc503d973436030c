// What a facet and a corner of a face leave to the elements on them.

#include "mesh/facet_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

constexpr double degree = M_PI / 180;

TEST(FacetBound, IsOneOnARegularTriangleWhereverItLies) {
  const Vec3 a(1, 2, 3), b(1, 2, 5), c(1 + std::sqrt(3), 2, 4);
  EXPECT_NEAR(best_on_triangle(a, b, c), 1, 1e-6);
  EXPECT_NEAR(best_on_triangle(b, a, c), 1, 1e-6);
}

TEST(FacetBound, IsZeroWithoutArea) {
  EXPECT_EQ(best_on_triangle(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)), 0);
  EXPECT_EQ(best_on_triangle(Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(2, 0, 0)), 0);
}

/// On an isosceles needle the best place lies in its plane of symmetry: searched on a grid there.
TEST(FacetBound, IsTheBestOfAGridOverNeedles) {
  for (const double angle : {3.0, 6.5, 10.0, 30.0}) {
    const double half = angle * degree / 2;
    const Vec3 b(std::cos(half), std::sin(half), 0), c(b[0], -b[1], 0);
    double best = 0;
    for (int i = 0; i <= 400; ++i)
      for (int k = 1; k <= 400; ++k)
        best = std::max(best,
                        std::abs(radius_ratio(Vec3::Zero(), b, c, Vec3(i / 400.0, 0, k / 400.0))));
    EXPECT_NEAR(best_at_corner(angle * degree), best, 2e-5) << angle;
    EXPECT_GE(best_at_corner(angle * degree), best - 1e-7) << angle;
  }
}

TEST(FacetBound, NoTetrahedronOnTheFacetIsBetter) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = point(), b = point(), c = point();
    const double bound = best_on_triangle(a, b, c);
    EXPECT_LE(bound, 1 + 1e-12);
    for (int k = 0; k < 500; ++k)
      ASSERT_LE(std::abs(radius_ratio(a, b, c, 2 * point())), bound + 1e-6);
  }
}

TEST(FacetBound, SidesAlikeAreTheBestAtACorner) {
  for (const double angle : {4.8, 9.3, 45.0})
    for (const double side : {0.7, 0.9, 1.15, 1.6}) {
      const Vec3 b(side * std::cos(angle * degree), side * std::sin(angle * degree), 0);
      EXPECT_LT(best_on_triangle(Vec3::Zero(), Vec3::UnitX(), b), best_at_corner(angle * degree));
    }
}

TEST(FacetBound, GrowsWithTheCorner) {
  double before = 0;
  for (const double angle : {1.0, 5.0, 10.0, 25.0, 50.0}) {
    EXPECT_GT(best_at_corner(angle * degree), before);
    before = best_at_corner(angle * degree);
  }
  EXPECT_LT(before, 1);
  EXPECT_EQ(best_at_corner(90 * degree), 1);
}

TEST(FacetBound, OfASurfaceIsThatOfItsWorstTriangle) {
  SurfaceMesh surface{{{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}, {0.5, 0.5, 0.5}},
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  double least = 1;
  for (const auto& t : surface.triangles)
    least = std::min(
        least, best_on_triangle(surface.nodes[t[0]], surface.nodes[t[1]], surface.nodes[t[2]]));
  EXPECT_LT(least, 0.5);
  EXPECT_DOUBLE_EQ(surface_bound(surface, 1), least);
  EXPECT_EQ(surface_bound(surface, 0.1), 0.1);
}

}  // namespace
}  // namespace polyslip::mesh
