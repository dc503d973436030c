#include "mesh/planar_mesher.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "mesh/face_mesher.hpp"
#include "mesh/planar_triangulation.hpp"
#include "polygons.hpp"

namespace polyslip::mesh {
namespace {

using Eigen::Vector2d;
using test::expect_mesh_of;
using test::problem_of;
using test::random_polygon;

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
      mean_O += mesh_quality_O(mesh, length);
    }
  }
  EXPECT_GT(mean_O / convex, 0.93);
  RecordProperty("mean_O", std::to_string(mean_O / convex));
}

}  // namespace
}  // namespace polyslip::mesh
