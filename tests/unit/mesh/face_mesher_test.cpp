// One suite for every mesher of faces, what a broken one costs, and which mesh wins.

#include "mesh/face_mesher.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "core/error.hpp"
#include "mesh/volume_mesher.hpp"
#include "polygons.hpp"

namespace polyslip::mesh {
namespace {

using Eigen::Vector2d;
using test::expect_mesh_of;
using test::problem_of;

const std::string worker = POLYSLIP_BINARY_DIR "/polyslip-mesher";

/// `faults` as in POLYSLIP_MESHER_FAULT.
std::unique_ptr<MesherPool> start_pool(const std::string& faults = "") {
  setenv("POLYSLIP_MESHER_FAULT", faults.c_str(), 1);
  auto pool = MesherPool::start(worker);
  unsetenv("POLYSLIP_MESHER_FAULT");
  return pool;
}

std::vector<PlanarMesh> mesh_all(const std::vector<FaceRequest>& requests,
                                 const std::string& mesher, int jobs = 0) {
  if (mesher != own_face_mesher) {
    PoolOptions options;
    options.jobs = jobs;
    return start_pool()->mesh_faces(requests, mesher, options);
  }
  std::vector<PlanarMesh> meshes(requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) mesh_polygon(requests[i].problem, meshes[i]);
  return meshes;
}

std::vector<FaceRequest> polygons(int count) {
  core::Random random(5, core::Stream::tests);
  std::vector<FaceRequest> requests;
  for (int i = 0; i < count; ++i) {
    const int corners = 3 + static_cast<int>(random.index(8));
    const auto polygon = test::random_polygon(random, corners, i % 2 == 0 ? 0.0 : 0.5);
    requests.push_back({i, problem_of(polygon, random.uniform(0.15, 0.6))});
  }
  return requests;
}

bool identical(const PlanarMesh& a, const PlanarMesh& b) {
  return a.points == b.points && a.triangles == b.triangles && a.fault == b.fault;
}

void expect_identical(const std::vector<PlanarMesh>& a, const std::vector<PlanarMesh>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(identical(a[i], b[i])) << i;
}

class EveryFaceMesher : public testing::TestWithParam<std::string> {};

TEST_P(EveryFaceMesher, MeshesPolygonsAndKeepsTheirBoundary) {
  const auto requests = polygons(300);
  const auto meshes = mesh_all(requests, GetParam());
  ASSERT_EQ(meshes.size(), requests.size());
  double mean_O = 0;
  int convex = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    ASSERT_EQ(meshes[i].fault, "") << i;
    expect_mesh_of(requests[i].problem, meshes[i]);
    EXPECT_EQ(validate(requests[i].problem, meshes[i]), "") << i;
    if (i % 2 == 1) continue;
    mean_O += mesh_quality_O(meshes[i], requests[i].problem.element_size);
    ++convex;
  }
  EXPECT_GT(mean_O / convex, 0.85);
  RecordProperty("mean_O", std::to_string(mean_O / convex));
}

TEST_P(EveryFaceMesher, MeshesAcuteCornersAndFineBoundaries) {
  std::vector<FaceRequest> requests;
  for (const double angle : {0.3, 0.1, 0.02})
    requests.push_back({static_cast<int>(requests.size()),
                        problem_of({{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}}, 0.13)});
  requests.push_back({3, problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 3.0)});
  requests.push_back({4, problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.04)});
  requests.back().problem.element_size = 0.4;
  const auto meshes = mesh_all(requests, GetParam());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    ASSERT_EQ(meshes[i].fault, "") << i;
    expect_mesh_of(requests[i].problem, meshes[i]);
  }
  EXPECT_LE(meshes[3].triangles.size(), 4u);
  // Ours lets sizes grow from 0.04 at the boundary; Gmsh keeps what the boundary has.
  EXPECT_LT(meshes[4].triangles.size(), GetParam() == own_face_mesher ? 900u : 2000u);
  EXPECT_GT(min_radius_ratio(meshes[4]), 0.4);
}

TEST_P(EveryFaceMesher, CutsForbiddenEdges) {
  FaceRequest request{0, problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0)};
  request.problem.forbidden_edges = {{0, 2}, {1, 3}};
  const auto mesh = mesh_all({request}, GetParam())[0];
  ASSERT_EQ(mesh.fault, "");
  EXPECT_EQ(mesh.triangles.size(), 4u);
  expect_mesh_of(request.problem, mesh);
}

TEST_P(EveryFaceMesher, SaysWhyThereIsNoMesh) {
  const std::vector<FaceRequest> requests{{0, problem_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.3)},
                                          {1, problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.3)},
                                          {2, problem_of({{0, 0}, {std::nan(""), 1}, {1, 0}}, 2)},
                                          {3, {}}};
  const auto meshes = mesh_all(requests, GetParam());
  EXPECT_EQ(meshes[0].fault, "its projected boundary meets itself or turns right");
  EXPECT_EQ(meshes[1].fault, "");
  EXPECT_EQ(meshes[2].fault, "a node of its boundary is not finite");
  EXPECT_EQ(meshes[3].fault, "its boundary has less than three nodes");
}

TEST_P(EveryFaceMesher, GivesTheSameForAnyNumberOfJobs) {
  const auto requests = polygons(450);  // three batches
  const auto one = mesh_all(requests, GetParam(), 1);
  for (const int jobs : {2, 3}) expect_identical(one, mesh_all(requests, GetParam(), jobs));
}

INSTANTIATE_TEST_SUITE_P(Faces, EveryFaceMesher,
                         testing::Values("own", "gmsh-frontal", "gmsh-delaunay"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(FaceMeshers, AreAllInTheSuite) {
  EXPECT_EQ(std::vector<std::string>(known_face_meshers.begin(), known_face_meshers.end()),
            (std::vector<std::string>{"own", "gmsh-frontal", "gmsh-delaunay"}));
  EXPECT_THROW(start_pool()->mesh_faces(polygons(1), "own", {}), core::InputError);
  EXPECT_THROW(start_pool()->mesh_faces(polygons(1), "triangle", {}), core::InputError);
}

struct Fault {
  std::string kind, text;
};

class InjectedFaceFault : public testing::TestWithParam<Fault> {};

TEST_P(InjectedFaceFault, CostsOneFace) {
  const auto requests = polygons(8);
  PoolOptions options;
  options.timeout = 2;
  const auto sound = start_pool()->mesh_faces(requests, "gmsh-frontal", options);
  auto meshes = start_pool("gmsh-frontal:3:" + GetParam().kind)
                    ->mesh_faces(requests, "gmsh-frontal", options);
  EXPECT_EQ(meshes[3].fault.find("mesher 'gmsh-frontal', face 4: "), 0u) << meshes[3].fault;
  EXPECT_NE(meshes[3].fault.find(GetParam().text), std::string::npos) << meshes[3].fault;
  EXPECT_TRUE(meshes[3].triangles.empty());
  meshes[3] = sound[3];
  expect_identical(sound, meshes);
}

INSTANTIATE_TEST_SUITE_P(Faces, InjectedFaceFault,
                         testing::Values(Fault{"crash", "killed by signal 11 (Segmentation fault)"},
                                         Fault{"hang", "killed after 2 s of CPU"},
                                         Fault{"throw", "exception: asked to throw"},
                                         Fault{"nan", "is not finite"},
                                         Fault{"move", "boundary node 0 has moved"},
                                         Fault{"garbage", "garbage for an answer (not a header)"}),
                         [](const auto& tested) { return tested.param.kind; });

TEST(FaceMeshers, KnowMeshesThatAreNone) {
  const auto problem = problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0);
  PlanarMesh mesh;
  ASSERT_TRUE(mesh_polygon(problem, mesh));
  ASSERT_EQ(validate(problem, mesh), "");
  const auto fault = [&](auto&& change) {
    PlanarMesh changed = mesh;
    change(changed);
    return validate(problem, changed);
  };
  EXPECT_EQ(fault([](PlanarMesh& m) { m.triangles.clear(); }), "no triangles");
  EXPECT_EQ(fault([](PlanarMesh& m) { m.points[2][0] += 1e-15; }), "boundary node 2 has moved");
  EXPECT_EQ(fault([](PlanarMesh& m) { m.points.push_back({0.5, 0.5}); }), "node 4 is unused");
  EXPECT_EQ(fault([](PlanarMesh& m) { m.triangles[0][0] = 9; }), "a triangle has node 9 of 4");
  EXPECT_EQ(fault([](PlanarMesh& m) { std::swap(m.triangles[0][0], m.triangles[0][1]); }),
            "two triangles on one side of an edge");
  EXPECT_NE(fault([](PlanarMesh& m) { m.triangles.pop_back(); }), "");
  auto forbidding = problem;
  forbidding.forbidden_edges = {{0, 2}, {1, 3}};
  EXPECT_NE(validate(forbidding, mesh).find("are joined by an edge"), std::string::npos);
}

TEST(FaceCandidates, TakeTheBestByTheFloorThenByO) {
  const auto problem = problem_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.5);
  EXPECT_EQ(worst_triangle_floor(problem), 0.3);
  // A corner of w allows 8 sin(w/2) sin^2((pi - w)/4) = 4 s (1 - s), s = sin(w/2).
  const double w = 0.1, s = std::sin(w / 2);
  EXPECT_NEAR(worst_triangle_floor(problem_of({{0, 0}, {1, 0}, {std::cos(w), std::sin(w)}}, 2.0)),
              0.7 * 4 * s * (1 - s), 1e-12);
  PlanarMesh good;
  ASSERT_TRUE(mesh_polygon(problem, good));
  // A node at the side's middle is dragged near the boundary: a flat triangle.
  PlanarMesh flat = good;
  ASSERT_GT(flat.points.size(), problem.boundary.size());
  flat.points.back() = Vector2d(0.5, 0.02);
  const bool still_one = validate(problem, flat).empty();
  if (!still_one) flat = good, flat.points.back() += Vector2d(0.2, 0);
  ASSERT_EQ(validate(problem, flat), "");
  ASSERT_LT(mesh_quality_O(flat, 0.5), mesh_quality_O(good, 0.5));
  PlanarMesh broken = good;
  broken.fault = "no mesh";
  for (const bool first : {true, false}) {
    FaceCandidates candidates(problem);
    candidates.offer(2, PlanarMesh(broken));
    EXPECT_FALSE(candidates.any());
    candidates.offer(first ? 0 : 1, PlanarMesh(first ? flat : good));
    candidates.offer(first ? 1 : 0, PlanarMesh(first ? good : flat));
    EXPECT_EQ(candidates.mesher(), 1u);
    EXPECT_TRUE(identical(candidates.best(), good));
    EXPECT_TRUE(candidates.good_enough());
  }
}

}  // namespace
}  // namespace polyslip::mesh
