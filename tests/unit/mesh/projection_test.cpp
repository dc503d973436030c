// Points of faces, and surfaces that meet themselves.

#include "mesh/projection.hpp"

#include <gtest/gtest.h>

#include "mesh/self_intersection.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// A unit square in two triangles that lacks a corner of the given size.
FaceShape cut_square(double cut) {
  FaceShape shape;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const int n = static_cast<int>(shape.points.size());
    for (const Vec3& x : {a, b, c, Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)})
      shape.points.push_back(x);
    shape.triangles.push_back({n, n + 1, n + 2, n + 3, n + 4, n + 5});
  };
  add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add({1, 0, 0}, {1, 1 - cut, 0}, {0, 1, 0});
  return shape;
}

TEST(FaceProjection, TellsHowFarBeyondTheFaceAPointIs) {
  const FaceShape shape = cut_square(0.5);
  const FaceProjection projection(shape, Vec3::Ones());
  EXPECT_NEAR(projection.extent(), 1, 1e-14);
  double beyond = -1;
  EXPECT_LT(
      (projection.lift(projection.project({0.3, 0.3, 0}), &beyond) - Vec3(0.3, 0.3, 0)).norm(),
      1e-12);
  EXPECT_EQ(beyond, 0);
  EXPECT_LT((projection.lift(projection.project({1, 0.55, 0}), &beyond) - Vec3(1, 0.55, 0)).norm(),
            1e-12)
      << "just outside the surface goes on";
  EXPECT_EQ(beyond, 0);
  const Vec3 far(3, 2, 0), x = projection.lift(projection.project(far), &beyond);
  EXPECT_LT((x - Vec3(1, 0.5, 0)).norm(), 1e-9);
  EXPECT_NEAR(beyond, (far - x).norm(), 1e-12);
}

/// A step towards a target beyond the face would find its edge, but leave the plane region.
TEST(FaceProjection, StaysOnTheFaceWhereTheNearestPointIsBeyondIt) {
  const FaceShape shape = cut_square(0.5);
  const FaceProjection projection(shape, Vec3::Ones());
  const Vec3 from(0.9, 0.25, 0);
  const Eigen::Vector2d start = projection.project(from);
  Eigen::Vector2d place = start;
  double beyond = -1;
  const Vec3 x = projection.nearest({1.6, 0.25, 0.1}, place, &beyond);
  EXPECT_EQ(beyond, 0);
  EXPECT_LT((x - from).norm(), 1e-12);
  EXPECT_EQ((place - start).norm(), 0);
  const Vec3 near = projection.nearest({0.8, 0.2, 0.1}, place, &beyond);
  EXPECT_LT((near - Vec3(0.8, 0.2, 0)).norm(), 1e-9);
  EXPECT_EQ(beyond, 0);
}

TEST(SelfIntersection, FindsTheTrianglesThatPierceEachOther) {
  SurfaceMesh s;
  s.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.9, 1}};
  s.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(intersecting_triangles(s), (std::vector<int>{0, 1}));
  for (int i = 3; i < 6; ++i) s.nodes[i][2] += 2;
  EXPECT_TRUE(intersecting_triangles(s).empty());
}

}  // namespace
}  // namespace polyslip::mesh
