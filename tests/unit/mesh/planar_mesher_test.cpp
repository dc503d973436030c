#include "mesh/planar_mesher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/random.hpp"
#include "mesh/planar_triangulation.hpp"

namespace polyslip::mesh {
namespace {

using Eigen::Vector2d;

double area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) / 2;
}

/// Corner points joined by straight rows of points about `length` apart.
PlanarProblem problem_of(const std::vector<Vector2d>& corners, double length) {
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
void expect_mesh_of(const PlanarProblem& problem, const PlanarMesh& mesh) {
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

/// O of eqs. (5)-(7) in two dimensions.
double quality_O(const PlanarMesh& mesh, double element_size) {
  double log_dis = 0, size = 0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    const double rho = radius_ratio(a, b, c);
    const double l = ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3;
    const double s = std::pow(std::max(rho, 1e-300), 0.1);
    if (rho < 1) log_dis += std::exp(s / (s - 1)) * std::log(rho);
    size += std::min(l / element_size, element_size / l) / mesh.triangles.size();
  }
  return std::exp(0.8 * log_dis + 0.6 * std::log(size));
}

/// A star-shaped polygon: random radii at random angles.
std::vector<Vector2d> random_polygon(core::Random& random, int corners, double roughness) {
  std::vector<double> angles;
  for (int i = 0; i < corners; ++i)
    angles.push_back(2 * M_PI * (i + 0.4 * random.uniform()) / corners);
  std::vector<Vector2d> polygon;
  for (double a : angles)
    polygon.push_back((1 - roughness * random.uniform()) * Vector2d(std::cos(a), std::sin(a)));
  return polygon;
}

TEST(PlanarTriangulation, PredicatesAreExactAtTheLimitOfTheGrid) {
  const std::int64_t m = (1 << 28) - 1;
  EXPECT_EQ(orientation({-m, -m}, {m, m}, {0, 0}), 0);
  EXPECT_GT(orientation({-m, -m}, {m, m}, {m - 1, m}), 0);
  EXPECT_FALSE(in_circle({-m, -m}, {m, -m}, {m, m}, {-m, m}));
  EXPECT_TRUE(in_circle({-m, -m}, {m, -m}, {m, m}, {-m + 1, m}));
}

TEST(PlanarTriangulation, KnowsPolygonsThatAreNotSimple) {
  EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_FALSE(is_simple({{0, 0}, {0, 2}, {2, 2}, {2, 0}})) << "turns right";
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {0, 2}, {2, 2}})) << "bow tie";
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 0}, {2, 2}})) << "repeated";
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {2, 0}, {2, 2}})) << "spike";
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})) << "touches itself";
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {2, 0}})) << "flat";
}

TEST(PlanarMesher, MeshesSquaresAndTriangles) {
  for (double length : {3.0, 1.0, 0.5, 0.21, 0.05})
    for (const auto& corners : {std::vector<Vector2d>{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                                std::vector<Vector2d>{{0, 0}, {1, 0}, {0.5, 0.8}}}) {
      const auto problem = problem_of(corners, length);
      PlanarMesh mesh;
      ASSERT_TRUE(mesh_polygon(problem, mesh));
      expect_mesh_of(problem, mesh);
      for (const auto& t : mesh.triangles)
        EXPECT_GT(radius_ratio(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]), 0.45)
            << length;
    }
}

TEST(PlanarMesher, MeshesAcuteCornersAndNeedles) {
  for (double angle : {0.3, 0.1, 0.02, 1e-3, 1e-5}) {
    const auto problem = problem_of({{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}}, 0.13);
    PlanarMesh mesh;
    ASSERT_TRUE(mesh_polygon(problem, mesh)) << angle;
    expect_mesh_of(problem, mesh);
  }
}

TEST(PlanarMesher, SplitsForbiddenEdges) {
  PlanarProblem problem = problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0);
  PlanarMesh mesh;
  ASSERT_TRUE(mesh_polygon(problem, mesh));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  problem.forbidden_edges = {{0, 2}, {1, 3}};
  ASSERT_TRUE(mesh_polygon(problem, mesh));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.points.size(), 5u);
  expect_mesh_of(problem, mesh);
}

TEST(PlanarMesher, RefusesPolygonsThatAreNotSimple) {
  PlanarMesh mesh;
  EXPECT_FALSE(mesh_polygon(problem_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.3), mesh));
  EXPECT_FALSE(mesh_polygon(problem_of({{0, 0}, {0, 1}, {1, 0}}, 0.3), mesh));
  EXPECT_FALSE(mesh_polygon(problem_of({{0, 0}, {std::nan(""), 1}, {1, 0}}, 2), mesh));
  EXPECT_FALSE(mesh_polygon(PlanarProblem{}, mesh));
}

TEST(PlanarMesher, MeshesTwoThousandRandomPolygons) {
  core::Random random(1, core::Stream::tests);
  double mean_O = 0;
  int convex = 0;
  for (int i = 0; i < 2000; ++i) {
    const int corners = 3 + static_cast<int>(random.index(10));
    const double roughness = i % 2 == 0 ? 0.0 : random.uniform(0, 0.9);
    const double length = random.uniform(0.15, 0.6);
    const auto problem = problem_of(random_polygon(random, corners, roughness), length);
    PlanarMesh mesh;
    ASSERT_TRUE(mesh_polygon(problem, mesh)) << i;
    expect_mesh_of(problem, mesh);
    if (roughness == 0.0 && corners > 3) {
      ++convex;
      mean_O += quality_O(mesh, length);
    }
  }
  EXPECT_GT(mean_O / convex, 0.93);
  RecordProperty("mean_O", std::to_string(mean_O / convex));
}

}  // namespace
}  // namespace polyslip::mesh
