#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include "core/error.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/pipeline.hpp"
#include "star_meshes.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using namespace test;

TEST(MeshGeometry, MeshesCubesOfOneTwoAndEightCells) {
  const auto two =
      geometry_of(voronoi_tessellation({Vec3(0.5, 0.5, 0.5), Vec3(1.5, 0.5, 0.5)}, Vec3(2, 1, 1)));
  for (const auto& geometry : {cubes(1), two, cubes(2)})
    for (double size : {2.0, 0.5, 0.3})
      for (int order : {1, 2}) {
        MeshingReport report;
        auto options = options_of(size);
        options.order = order;
        const Mesh mesh = star_mesh(geometry, options, report);
        ASSERT_NO_THROW(check(mesh));
        expect_box(mesh);
        EXPECT_NEAR(sum(grain_volumes(mesh)) / mesh.size.prod(), 1, 1e-12);
        for (double v : grain_volumes(mesh)) EXPECT_NEAR(v, 1, 1e-12);
        EXPECT_EQ(report.wins, std::vector<int>{mesh.topology.cell_count()});
        EXPECT_EQ(report.straightened, 0);
        EXPECT_TRUE(report.copied_faces.empty());
      }
}

TEST(MeshGeometry, MeshesACubeWithTheSizesOfTheScaledFrame) {
  MeshingReport report;
  const Mesh mesh = star_mesh(cubes(1), options_of(0.5), report, Vec3(2, 1, 0.5));
  ASSERT_NO_THROW(check(mesh));
  std::map<int, int> count;
  for (std::size_t i = 0; i < mesh.lines.size(); ++i) {
    const Vec3 d = mesh.nodes[mesh.lines[i][1]] - mesh.nodes[mesh.lines[i][0]];
    int axis = 0;
    d.cwiseAbs().maxCoeff(&axis);
    ++count[axis];
  }
  EXPECT_EQ(count[0], 4 * 4);
  EXPECT_EQ(count[1], 4 * 2);
  EXPECT_EQ(count[2], 4 * 1);
  EXPECT_NEAR(sum(grain_volumes(mesh)), 1, 1e-12);
}

TEST(MeshGeometry, MeshesAVoronoiPolycrystal) {
  const auto tessellation = voronoi_tessellation(PolycrystalOptions{.grains = 20, .seed = 3});
  MeshingReport report;
  const Mesh mesh = star_mesh(geometry_of(tessellation), options_of(0.5), report);
  ASSERT_NO_THROW(check(mesh));
  expect_box(mesh);
  EXPECT_NEAR(sum(grain_volumes(mesh)) / mesh.size.prod(), 1, 1e-12);
  const auto volumes = grain_volumes(mesh);
  for (int c = 0; c < 20; ++c) EXPECT_NEAR(volumes[c], cell_volume(tessellation, c), 1e-9);
}

TEST(MeshGeometry, GivesBackTheGeometryOfAMesh) {
  MeshingReport report;
  const Mesh mesh = star_mesh(cubes(2), options_of(0.5), report);
  const Geometry g = geometry_of(mesh);
  EXPECT_TRUE(g.from_mesh);
  ASSERT_EQ(g.edges.size(), mesh.topology.edges.size());
  std::size_t triangles = 0, points = 0;
  for (const auto& f : g.faces) triangles += f.triangles.size();
  for (const auto& e : g.edges) {
    ASSERT_EQ(e.points.size() % 2, 1u);
    points += (e.points.size() - 1) / 2;
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  EXPECT_EQ(points, mesh.lines.size());
  for (std::size_t e = 0; e < g.edges.size(); ++e) {
    EXPECT_EQ(g.edges[e].points.front(), g.vertices[mesh.topology.edges[e].vertices[0]]);
    EXPECT_EQ(g.edges[e].points.back(), g.vertices[mesh.topology.edges[e].vertices[1]]);
  }
  Mesh linear = mesh;
  linear.order = 1;
  EXPECT_THROW(geometry_of(linear), core::InternalError);
}

TEST(MeshGeometry, RemeshesOnTheOldQuadraticSurface) {
  MeshingReport report;
  Mesh old = star_mesh(cubes(2), options_of(0.34), report);
  for (auto& x : old.nodes) x = deformed(x, 0.3, 0.08);
  ASSERT_NO_THROW(check(old));
  for (const Vec3& scale : {Vec3(1, 1, 1), Vec3(std::exp(-0.3), 1, std::exp(0.3))}) {
    const Mesh mesh = star_mesh(geometry_of(old), options_of(0.3), report, scale);
    ASSERT_NO_THROW(check(mesh));
    EXPECT_TRUE(report.copied_faces.empty());
    EXPECT_LT(largest_change(grain_volumes(mesh), grain_volumes(old)), 1e-5);
    for (int v = 0; v < mesh.topology.vertex_count; ++v)
      EXPECT_EQ(mesh.nodes[mesh.vertex_nodes[v]], old.nodes[old.vertex_nodes[v]]);
  }
}

TEST(MeshGeometry, RemeshingAQuadraticMapOfFlatFacesKeepsItsVolumeAndSurface) {
  // z += a x^2 + b x y is reproduced by quadratic triangles, whatever their size.
  MeshingReport report;
  Mesh old = star_mesh(cubes(1), options_of(0.5), report);
  const auto lift = [](const Vec3& x) { return 0.2 * x[0] * x[0] + 0.1 * x[0] * x[1]; };
  for (auto& x : old.nodes) x[2] += lift(x);
  const Mesh mesh = star_mesh(geometry_of(old), options_of(0.31), report);
  ASSERT_NO_THROW(check(mesh));
  EXPECT_NEAR(sum(grain_volumes(mesh)), 1, 1e-6);
  int looked_at = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& face = mesh.topology.faces[mesh.triangle_face[i]];
    if (face.domain_face != 4 && face.domain_face != 5) continue;
    for (int k = 0; k < 6; ++k) {
      const Vec3& x = mesh.nodes[mesh.triangles[i][k]];
      // Mid nodes may have moved a little for the volume's sake.
      EXPECT_NEAR(x[2] - lift(x), face.domain_face == 4 ? 0.0 : 1.0, k < 3 ? 1e-12 : 1e-3);
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 100);
}

TEST(BoundaryMesher, LaysAFoldedFaceFlatByAMapAndCopiesItWithItsEdgesIfAsked) {
  MeshingReport report;
  Geometry g = geometry_of(star_mesh(cubes(2), options_of(0.34), report));
  const auto& faces = g.topology.faces;
  const int folded = static_cast<int>(
      std::find_if(faces.begin(), faces.end(), [](auto& f) { return f.domain_face < 0; }) -
      faces.begin());
  // What lies inside the face is dragged sideways, beyond its boundary.
  auto& shape = g.faces[folded];
  Vec3 low = shape.points[0], high = low;
  for (const auto& x : shape.points) low = low.cwiseMin(x), high = high.cwiseMax(x);
  int normal = 0;
  (high - low).minCoeff(&normal);
  const Vec3 middle = (low + high) / 2;
  for (auto& x : shape.points) {
    const double r = 2 * (x - middle).cwiseAbs().maxCoeff();
    if (r < 0.99) x[(normal + 1) % 3] += 0.9 * (1 - r);
  }
  const auto options = options_of(0.5);
  BoundaryMesher mesher(g, options, Vec3::Ones());
  EXPECT_EQ(mesher.update().size(), faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    EXPECT_FALSE(mesher.is_copied(f)) << f;
    EXPECT_EQ(mesher.faces()[f].flattening != Flattening::mean_plane, f == folded) << f;
  }
  EXPECT_TRUE(mesher.copy(folded, "asked for"));
  EXPECT_FALSE(mesher.copy(folded, "again"));
  EXPECT_EQ(mesher.why_copied(folded), "asked for");
  EXPECT_LT(mesher.update().size(), faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    EXPECT_EQ(mesher.is_copied(f), f == folded) << f;
  const auto& copy = mesher.faces()[folded];
  EXPECT_EQ(copy.triangles.size(), shape.triangles.size());
  EXPECT_EQ(
      copy.boundary_count + copy.inner_nodes.size() + copy.boundary_count + copy.inner_edges.size(),
      shape.points.size());
  for (int e : faces[folded].edges) {
    const auto& m = mesher.edges()[e];
    ASSERT_EQ(m.nodes.size() + m.mids.size(), g.edges[e].points.size());
    for (std::size_t i = 0; i < m.mids.size(); ++i) {
      EXPECT_EQ(m.nodes[i], g.edges[e].points[2 * i]);
      EXPECT_EQ(m.mids[i], g.edges[e].points[2 * i + 1]);
    }
  }
  EXPECT_TRUE(mesher.update().empty());
  g.from_mesh = false;
  auto& chain = g.edges[faces[folded].edges[0]].points;  // crosses the opposite side
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) chain[i] += 4 * (middle - chain[i]);
  BoundaryMesher strict(g, options, Vec3::Ones());
  try {
    strict.update();
    FAIL() << "there is no old mesh to keep";
  } catch (const core::RecoverableError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("face "), 0u) << text;
    EXPECT_NE(text.find("its projected boundary meets itself"), std::string::npos) << text;
  }
}

TEST(BoundaryMesher, CopiesAFaceOfWhichHalfIsMissing) {
  MeshingReport report;
  Geometry g = geometry_of(star_mesh(cubes(1), options_of(0.2), report));
  auto& shape = g.faces[0];
  Vec3 middle = Vec3::Zero();
  for (const auto& x : shape.points) middle += x / static_cast<double>(shape.points.size());
  const Vec3 across = (shape.points[shape.triangles[0][0]] - middle).normalized();
  for (double kept :
       {1.0, 0.5, 0.0}) {  // of the distance to its far side, in which nothing is left
    std::erase_if(shape.triangles, [&](const std::array<int, 6>& t) {
      const Vec3 x = (shape.points[t[0]] + shape.points[t[1]] + shape.points[t[2]]) / 3;
      return kept < 1 && (x - middle).dot(across) > kept * 0.5;
    });
    BoundaryMesher mesher(g, options_of(0.2), Vec3::Ones());
    mesher.update();
    EXPECT_EQ(mesher.is_copied(0), kept < 1) << kept;
    EXPECT_EQ(mesher.faces()[0].nearest_points, 0) << "of a copied face none counts";
  }
}

TEST(MeshGeometry, CopiesEveryFaceOfAGrainThatFailsOtherwise) {
  MeshingReport report;
  const Mesh old = star_mesh(cubes(2), options_of(0.34), report);
  const auto old_faces = old.topology.cell_faces[5];
  std::size_t old_triangles = 0;
  for (std::size_t i = 0; i < old.triangles.size(); ++i)
    old_triangles += std::count(old_faces.begin(), old_faces.end(), old.triangle_face[i]);
  int rounds = 0;
  const auto picky = [&](const std::vector<GrainRequest>& requests) {
    ++rounds;
    auto results = star_meshes(requests);
    for (std::size_t i = 0; i < requests.size(); ++i)
      if (results[i].grain == 5 && requests[i].surface.triangles.size() != old_triangles)
        results[i].ok = false;
    return results;
  };
  const Mesh mesh =
      mesh_geometry(geometry_of(old), options_of(0.5), Vec3::Ones(), at_once(picky), report);
  ASSERT_NO_THROW(check(mesh));
  auto wanted = old_faces;
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(report.copied_faces, wanted);
  EXPECT_LE(rounds, 5);
  EXPECT_NEAR(sum(grain_volumes(mesh)), 8, 1e-11);
}

TEST(MeshGeometry, LeavesGrainsWithoutAFirstMeshToAllMeshers) {
  const auto first = [](const std::vector<GrainRequest>& requests) {
    auto results = star_meshes(requests);
    for (auto& r : results)
      if (r.grain == 2)
        r = {.grain = 2, .ok = false, .mesh = {}, .mesher = "", .O = 0, .faults = {"no"}};
    return results;
  };
  std::vector<std::vector<int>> asked;
  const auto others = [&](const std::vector<GrainRequest>& requests) {
    auto results = star_meshes(requests);
    asked.emplace_back();
    for (auto& r : results) {
      asked.back().push_back(r.grain);
      r.mesher = "second";
      r.O = 0;  // never better than what there is
    }
    return results;
  };
  auto options = options_of(0.34);
  options.meshers = {"star", "second"};
  options.slide_boundary = true;
  MeshingReport report;
  const Mesh mesh = mesh_geometry(cubes(2), options, Vec3::Ones(), at_once(others), report, {},
                                  {at_once(first), at_once(others)});
  ASSERT_NO_THROW(check(mesh));
  EXPECT_EQ(report.wins, (std::vector<int>{7, 1}));
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[0], std::vector<int>{2});
}

TEST(MeshGeometry, NamesTheGrainThatCannotBeMeshed) {
  const auto failing = [](const std::vector<GrainRequest>& requests) {
    auto results = star_meshes(requests);
    for (auto& r : results)
      if (r.grain == 2) r.ok = false, r.faults = {"star: refused"};
    return results;
  };
  MeshingReport report;
  for (bool from_mesh : {false, true}) {
    Geometry g = from_mesh ? geometry_of(star_mesh(cubes(2), options_of(0.5), report)) : cubes(2);
    try {
      mesh_geometry(g, options_of(0.5), Vec3::Ones(), at_once(failing), report);
      FAIL() << "nothing was thrown";
    } catch (const core::RecoverableError& error) {
      EXPECT_NE(std::string(error.what()).find("grain 3"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("refused"), std::string::npos) << error.what();
    }
  }
}

TEST(MeshGeometry, RefusesAFirstMeshThatDoesNotFillTheBox) {
  Geometry g = cubes(2);
  g.domain.volume *= 1 + 1e-11;
  MeshingReport report;
  EXPECT_THROW(star_mesh(g, options_of(0.5), report), core::InternalError);
}

TEST(MeshGeometry, TellsWhatWasGivenUp) {
  MeshingReport report;
  EXPECT_EQ(repairs_text(report), "");
  report.nearest_points = 2;
  report.copied_faces = {4};
  EXPECT_EQ(repairs_text(report),
            "0 mid nodes pulled towards their chord, 2 nodes put on the nearest point of their old "
            "face, 1 faces copied");
}

}  // namespace
}  // namespace polyslip::mesh
