#include "mesh/flattening.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mesh/projection.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Eigen::Vector2d;

/// Six-node triangles on the grid of (2 n + 1)^2 points of the unit square, by a map; without the
/// cells for which `hole` is true.
template <class Map, class Hole>
FaceShape grid(int n, const Map& map, const Hole& hole) {
  FaceShape shape;
  std::map<std::array<int, 2>, int> numbers;
  const auto point = [&](int i, int j) {
    const auto [at, added] = numbers.try_emplace({i, j}, static_cast<int>(shape.points.size()));
    if (added) shape.points.push_back(map(Vector2d(i, j) / (2 * n)));
    return at->second;
  };
  for (int i = 0; i < 2 * n; i += 2)
    for (int j = 0; j < 2 * n; j += 2) {
      if (hole(i / 2, j / 2)) continue;
      shape.triangles.push_back({point(i, j), point(i + 2, j), point(i + 2, j + 2), point(i + 1, j),
                                 point(i + 2, j + 1), point(i + 1, j + 1)});
      shape.triangles.push_back({point(i, j), point(i + 2, j + 2), point(i, j + 2),
                                 point(i + 1, j + 1), point(i + 1, j + 2), point(i, j + 1)});
    }
  return shape;
}

bool none(int, int) { return false; }

/// Part of a cylinder of 250 degrees: it folds in any projection.
Vec3 bent(const Vector2d& p) {
  const double angle = 250 * M_PI / 180 * p[0], radius = 180 / (250 * M_PI);
  return {radius * std::sin(angle), p[1], radius * std::cos(angle)};
}

TEST(Flattening, UnrollsACylinder) {
  const FaceShape shape = grid(12, bent, none);
  EXPECT_FALSE(FaceProjection(shape, Vec3::Ones()).projects(0));
  const auto places = conformal_places(shape, Vec3::Ones());
  ASSERT_EQ(places.size(), shape.points.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); j += 7) {
      // Distances on the cylinder are those in the plane (chords of 5 degrees: 0.05 %).
      const auto unrolled = [&](std::size_t k) {
        const Vec3& x = shape.points[k];
        double angle = std::atan2(x[0], x[2]);
        if (angle < -1e-9) angle += 2 * M_PI;
        return Vector2d(angle * 180 / (250 * M_PI), x[1]);
      };
      EXPECT_NEAR((places[i] - places[j]).norm(), (unrolled(i) - unrolled(j)).norm(), 2e-3);
    }
  const FaceProjection projection(shape, Vec3::Ones(), places);
  EXPECT_TRUE(projection.projects(0.9));
  EXPECT_FALSE(projection.is_mean_plane());
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT((projection.lift(places[i]) - shape.points[i]).norm(), 1e-9);
}

TEST(Flattening, FindsBoundaryPointsInThePlane) {
  const FaceShape shape = grid(6, bent, none);
  const FaceProjection projection(shape, Vec3::Ones(), conformal_places(shape, Vec3::Ones()));
  // On the quadratic segment between two neighbours of the side p_1 = 0.
  for (double t : {0.1, 0.25, 0.7}) {
    const auto &s = shape.triangles[0], &x = s;
    const Vec3 on = (1 - t) * (1 - 2 * t) * shape.points[x[0]] +
                    t * (2 * t - 1) * shape.points[x[1]] + 4 * t * (1 - t) * shape.points[x[3]];
    double beyond = -1;
    EXPECT_LT((projection.lift(projection.project(on), &beyond) - on).norm(), 1e-9);
    EXPECT_EQ(beyond, 0);
  }
}

TEST(Flattening, DescendsAlongTheSurface) {
  const FaceShape shape = grid(12, bent, none);
  const FaceProjection projection(shape, Vec3::Ones(), conformal_places(shape, Vec3::Ones()));
  const Vec3 gradient(0.3, 0.4, -0.7);
  Vector2d p = Vector2d::Zero();
  const auto places = conformal_places(shape, Vec3::Ones());
  for (int k = 0; k < 3; ++k) p += places[shape.triangles[150][k]] / 3;
  const auto d = projection.descent(p, gradient);
  const double h = 1e-4;
  const Vec3 move = projection.lift(p + h * d.direction) - projection.lift(p);
  EXPECT_NEAR(move.norm() / h, 1, 1e-2);
  EXPECT_NEAR(move.dot(gradient) / h, -d.slope, 1e-2);
}

/// A deep pocket whose opening is narrower than its inside.
Vec3 pocket(const Vector2d& p) {
  const Vector2d q = 2 * p - Vector2d(1, 1);
  const double r = std::min(1.0, std::max(std::abs(q[0]), std::abs(q[1])));
  const double turn = M_PI * 0.8 * (1 - r);
  const double out = q.norm() > 0 ? std::sin(M_PI - turn - 0.2 * M_PI) / q.norm() : 0;
  return {out * q[0], out * q[1], std::cos(M_PI - turn - 0.2 * M_PI)};
}

/// Every point of the shape, those of its boundary by projection, comes back to where it is.
void expect_the_way_back(const FaceShape& shape, const FaceProjection& projection,
                         const std::vector<Vector2d>& places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT((projection.lift(places[i]) - shape.points[i]).norm(), 1e-9) << i;
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : shape.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      ++sides[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  for (const auto& [side, count] : sides)
    for (const int i : side) {
      if (count != 1) continue;
      double beyond = -1;
      const Vec3& x = shape.points[static_cast<std::size_t>(i)];
      EXPECT_LT((projection.lift(projection.project(x), &beyond) - x).norm(), 1e-9) << i;
      EXPECT_EQ(beyond, 0) << i;
    }
}

TEST(Flattening, PutsAnySurfaceOfOneLoopOnACircleWithoutAFold) {
  const FaceShape shape = grid(9, pocket, none);
  EXPECT_FALSE(FaceProjection(shape, Vec3::Ones()).projects(0));
  const auto places = circle_places(shape, Vec3::Ones());
  const FaceProjection projection(shape, Vec3::Ones(), places);
  EXPECT_TRUE(projection.projects(0));
  expect_the_way_back(shape, projection, places);
}

TEST(Flattening, LaysAFaceWithAHoleFlat) {
  const FaceShape shape = grid(7, bent, [](int i, int j) { return i == 3 && j == 3; });
  const auto places = conformal_places(shape, Vec3::Ones());
  ASSERT_FALSE(places.empty());
  EXPECT_TRUE(FaceProjection(shape, Vec3::Ones(), places).projects(0.8));
}

TEST(Flattening, PutsAFaceWithHolesOnACircleWithoutAFold) {
  const FaceShape shape = grid(
      9, pocket, [](int i, int j) { return (i == 4 && j >= 3 && j <= 5) || (i == 1 && j == 6); });
  EXPECT_FALSE(FaceProjection(shape, Vec3::Ones()).projects(0));
  const auto places = circle_places(shape, Vec3::Ones());
  ASSERT_EQ(places.size(), shape.points.size());
  const FaceProjection projection(shape, Vec3::Ones(), places);
  EXPECT_TRUE(projection.projects(0));
  expect_the_way_back(shape, projection, places);
}

TEST(Flattening, RefusesLoopsThatMeet) {
  const FaceShape shape =
      grid(4, bent, [](int i, int j) { return (i == 1 && j == 1) || (i == 2 && j == 2); });
  EXPECT_TRUE(circle_places(shape, Vec3::Ones()).empty());
}

TEST(FaceProjection, ProjectsInOneFrameAndMeasuresInAnother) {
  const FaceShape shape = grid(
      3, [](const Vector2d& p) { return Vec3(p[0], p[1], 0.3 * p[0] * p[1]); }, none);
  const Vec3 sizes(1, 1, 3), isotropy(0.5, 1, 2);
  const FaceProjection projection(shape, sizes, isotropy);
  EXPECT_TRUE(projection.projects(0.3));
  for (const Vec3& x : shape.points)
    EXPECT_LT((projection.lift(projection.project(x)) - x).norm(), 1e-12);
  // In the plane lengths are those of the frame of sizes: a flat face keeps its own.
  const FaceShape flat = grid(
      2, [](const Vector2d& p) { return Vec3(p[0], p[1], p[0]); }, none);
  const FaceProjection of_flat(flat, sizes, isotropy);
  for (std::size_t i = 1; i < flat.points.size(); ++i)
    EXPECT_NEAR((of_flat.project(flat.points[i]) - of_flat.project(flat.points[0])).norm(),
                (flat.points[i] - flat.points[0]).cwiseProduct(sizes).norm(), 1e-12);
}

}  // namespace
}  // namespace polyslip::mesh
