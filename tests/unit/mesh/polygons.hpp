#pragma once
// Polygons to mesh, and what a mesh of one has to be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/random.hpp"
#include "mesh/planar_mesher.hpp"

namespace polyslip::mesh::test {

using Eigen::Vector2d;

inline double area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) / 2;
}

/// Corner points joined by straight rows of points about `length` apart.
inline PlanarProblem problem_of(const std::vector<Vector2d>& corners, double length) {
  PlanarProblem problem;
  problem.element_size = length;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int n = std::max(1, static_cast<int>(std::lround((b - a).norm() / length)));
    for (int k = 0; k < n; ++k) problem.boundary.push_back(a + (b - a) * (double(k) / n));
  }
  const std::size_t n = problem.boundary.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto &a = problem.boundary[(i + n - 1) % n], &b = problem.boundary[i],
               &c = problem.boundary[(i + 1) % n];
    problem.sizes.push_back(std::max((b - a).norm(), (c - b).norm()));
  }
  return problem;
}

/// Boundary kept node for node and edge for edge, inner edges shared by two, areas positive and
/// adding up, every point used.
inline void expect_mesh_of(const PlanarProblem& problem, const PlanarMesh& mesh) {
  const int n = static_cast<int>(problem.boundary.size());
  ASSERT_GE(mesh.points.size(), problem.boundary.size());
  ASSERT_FALSE(mesh.triangles.empty());
  double polygon = 0, total = 0;
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(mesh.points[i], problem.boundary[i]);
    polygon += area(mesh.points[0], mesh.points[i], mesh.points[(i + 1) % n]);
  }
  std::map<std::pair<int, int>, int> edges;
  std::vector<bool> used(mesh.points.size(), false);
  for (const auto& t : mesh.triangles) {
    const double a = area(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    EXPECT_GT(a, -1e-8 * polygon);
    total += a;
    for (int i = 0; i < 3; ++i) {
      used[t[i]] = true;
      EXPECT_EQ((++edges[{t[i], t[(i + 1) % 3]}]), 1);
    }
  }
  EXPECT_NEAR(total, polygon, 1e-12 * std::max(1.0, polygon));
  EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool u) { return u; }));
  int open = 0;
  for (const auto& [edge, count] : edges)
    if (!edges.count({edge.second, edge.first})) {
      ++open;
      EXPECT_EQ(edge.second, (edge.first + 1) % n);
    }
  EXPECT_EQ(open, n);
}

/// A star-shaped polygon: random radii at random angles.
inline std::vector<Vector2d> random_polygon(core::Random& random, int corners, double roughness) {
  std::vector<double> angles;
  for (int i = 0; i < corners; ++i)
    angles.push_back(2 * M_PI * (i + 0.4 * random.uniform()) / corners);
  std::vector<Vector2d> polygon;
  for (double a : angles)
    polygon.push_back((1 - roughness * random.uniform()) * Vector2d(std::cos(a), std::sin(a)));
  return polygon;
}

}  // namespace polyslip::mesh::test
