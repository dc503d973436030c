#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include "core/error.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/curvature_bound.hpp"
#include "mesh/curved_elements.hpp"
#include "mesh/pipeline.hpp"
#include "mesh/projection.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/volume_correction.hpp"
#include "surfaces.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Joins each surface triangle to the middle of the grain: valid if the grain is star-shaped.
std::vector<GrainResult> star_meshes(const std::vector<GrainRequest>& requests) {
  std::vector<GrainResult> results;
  for (const auto& r : requests) {
    GrainResult result{
        .grain = r.grain, .ok = true, .mesh = {}, .mesher = "star", .O = 1, .faults = {}};
    result.mesh.nodes = r.surface.nodes;
    Vec3 sum = Vec3::Zero();
    for (const auto& x : r.surface.nodes) sum += x;
    const int middle = static_cast<int>(result.mesh.nodes.size());
    result.mesh.nodes.push_back(sum / middle);
    for (const auto& t : r.surface.triangles)
      result.mesh.tetrahedra.push_back({t[0], t[2], t[1], middle});
    const auto why = validate(r.surface, result.mesh);
    if (!why.empty()) {
      result.ok = false;
      result.faults.push_back("star: " + why);
    }
    results.push_back(result);
  }
  return results;
}

MeshingOptions options_of(double element_size) {
  MeshingOptions options;
  options.element_size = element_size;
  options.meshers = {"star"};
  return options;
}

Mesh star_mesh(const Geometry& geometry, const MeshingOptions& options, MeshingReport& report,
               const Vec3& scale = Vec3::Ones()) {
  return mesh_geometry(geometry, options, scale, test::at_once(star_meshes), report);
}

/// n^3 cubes of unit volume.
Geometry cubes(int n) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) seeds.push_back(Vec3(i, j, k) + Vec3::Constant(0.5));
  return geometry_of(voronoi_tessellation(seeds, Vec3::Constant(n)));
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

/// Nodes of the flat domain faces lie on the box, bit for bit.
void expect_box(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int d = mesh.topology.faces[mesh.triangle_face[i]].domain_face;
    if (d < 0) continue;
    for (int n : mesh.triangles[i])
      if (n >= 0) {
        EXPECT_EQ(mesh.nodes[n][d / 2], d % 2 == 0 ? 0.0 : mesh.size[d / 2]);
      }
  }
}

/// Divergence-free motions: plane strain, and shears x_i += f(x_j) whose determinant is one.
Vec3 deformed(const Vec3& x0, double strain, double amplitude) {
  Vec3 x = x0;
  x[0] += amplitude * std::sin(1.9 * x[1] + 0.3) * std::sin(2.1 * x[2]);
  x[1] += amplitude * std::sin(2.3 * x[2] + 0.7) * std::cos(1.7 * x[0]);
  x[2] += amplitude * std::cos(2.0 * x[0] + 0.2) * std::sin(1.8 * x[1]);
  return x.cwiseProduct(Vec3(std::exp(strain), 1, std::exp(-strain)));
}

double largest_change(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] / b[i] - 1));
  return worst;
}

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
      mesh_geometry(geometry_of(old), options_of(0.5), Vec3::Ones(), test::at_once(picky), report);
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
  const Mesh mesh = mesh_geometry(cubes(2), options, Vec3::Ones(), test::at_once(others), report,
                                  {}, {test::at_once(first), test::at_once(others)});
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
      mesh_geometry(g, options_of(0.5), Vec3::Ones(), test::at_once(failing), report);
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

TEST(MeshGeometry, TellsWhatWasGivenUp) {
  MeshingReport report;
  EXPECT_EQ(repairs_text(report), "");
  report.nearest_points = 2;
  report.copied_faces = {4};
  EXPECT_EQ(repairs_text(report),
            "0 mid nodes pulled towards their chord, 2 nodes put on the nearest point of their old "
            "face, 1 faces copied");
}

TEST(CurvedElements, AreMendedInsideFirstAndThenAtTheSurface) {
  MeshingReport report;
  auto options = options_of(0.5);
  options.slide_boundary = false;
  const Mesh flat = star_mesh(cubes(1), options, report);
  for (double bulge : {0.08, 0.25}) {
    Mesh mesh = flat;
    std::vector<char> corner(mesh.nodes.size(), false);
    for (const auto& t : mesh.tetrahedra)
      for (int i = 0; i < 4; ++i) corner[t[i]] = true;
    for (const auto& t : mesh.triangles)
      for (int i = 3; i < 6; ++i)
        if (std::abs(mesh.nodes[t[i]][0] - 1) < 1e-12) mesh.nodes[t[i]][0] = 1 - bulge;
    const Mesh bent = mesh;
    double worst = 1;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const double least = least_jacobian_ratio(mesh, e), bound = curvature_bound(mesh, e);
      worst = std::min(worst, least);
      if (bound < 1) {
        EXPECT_GE(least, std::pow(1 - bound, 3) * (1 - 1e-12));
      }
    }
    Mesh other = mesh;
    const int moved = mend_curved_elements(mesh);
    EXPECT_EQ(mend_curved_elements(other, 3), moved);
    EXPECT_EQ(other.nodes, mesh.nodes);
    EXPECT_NO_THROW(check(mesh, 3));
    for (int e = 0; e < mesh.element_count(); ++e) EXPECT_GE(least_jacobian_ratio(mesh, e), 0.1);
    ASSERT_NO_THROW(check(mesh));
    int differ = 0, surface = 0;
    std::vector<char> on_surface(mesh.nodes.size(), false);
    for (const auto& t : mesh.triangles)
      for (int n : t) on_surface[n] = true;
    for (int n = 0; n < mesh.node_count(); ++n)
      if (mesh.nodes[n] != bent.nodes[n]) {
        EXPECT_FALSE(corner[n]);
        ++differ;
        surface += on_surface[n];
      }
    EXPECT_EQ(surface, moved);
    EXPECT_LT(worst, 0.1);
    EXPECT_GT(differ, 0);
    if (bulge > 0.2) {
      EXPECT_LT(worst, 0);
      EXPECT_GT(moved, 0);
    } else {
      EXPECT_EQ(moved, 0) << "inner mid nodes are enough";
    }
  }
  Mesh broken = flat;  // an element without volume whose curved edges do not help it
  const auto& t = broken.tetrahedra[3];
  broken.nodes[t[3]] = broken.nodes[t[0]];
  broken.nodes[t[4]] += Vec3(0.01, 0, 0);
  try {
    mend_curved_elements(broken);
    FAIL() << "nothing was thrown";
  } catch (const core::RecoverableError& error) {
    EXPECT_NE(std::string(error.what()).find("of grain 1 has no positive volume"),
              std::string::npos)
        << error.what();
  }
  broken = flat;
  broken.nodes[broken.tetrahedra[3][4]][1] = std::nan("");
  EXPECT_TRUE(std::isnan(least_jacobian_ratio(broken, 3)));
  Mesh linear = flat;
  linear.order = 1;
  EXPECT_EQ(mend_curved_elements(linear), 0);
}

TEST(VolumeCorrection, KnowsTheVolumesInsideQuadraticFaces) {
  MeshingReport report;
  Mesh mesh = star_mesh(cubes(2), options_of(0.5), report);
  for (auto& x : mesh.nodes) x = deformed(x, 0.3, 0.08);
  const auto inside = grain_volumes(geometry_of(mesh)), exact = grain_volumes(mesh);
  ASSERT_EQ(inside.size(), 8u);
  for (int g = 0; g < 8; ++g) EXPECT_NEAR(inside[g], exact[g], 1e-13);
}

TEST(VolumeCorrection, GivesGrainsTheVolumeAskedForByInnerMidNodesOnly) {
  MeshingReport report;
  const Mesh before = star_mesh(cubes(2), options_of(0.5), report);
  Mesh mesh = before;
  std::vector<double> wanted(8, 1.0);
  wanted[3] += 2e-3, wanted[6] -= 1e-3, wanted[0] -= 1e-3;
  std::vector<char> fixed;
  for (const auto& f : mesh.topology.faces) fixed.push_back(f.domain_face >= 0);
  const double largest = correct_volumes(mesh, wanted, fixed);
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(largest, 2e-3);
  const auto volumes = grain_volumes(mesh);
  for (int g = 0; g < 8; ++g) EXPECT_NEAR(volumes[g], wanted[g], 1e-7);
  ASSERT_NO_THROW(check(mesh));
  expect_box(mesh);
  std::vector<char> stays(mesh.nodes.size(), true);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!fixed[mesh.triangle_face[i]])
      for (int k = 3; k < 6; ++k) stays[mesh.triangles[i][k]] = false;
  for (const auto& l : mesh.lines) stays[l[2]] = true;
  for (int n = 0; n < mesh.node_count(); ++n) {
    if (stays[n]) {
      EXPECT_EQ(mesh.nodes[n], before.nodes[n]);
    }
  }
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
