// Nodes that slide in faces and along edges.

#include "mesh/boundary_sliding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/assembly.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/geometry.hpp"
#include "mesh/pipeline.hpp"
#include "mesh/star_mesh.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Tessellation polycrystal(int grains, std::uint64_t seed) {
  auto t = voronoi_tessellation(PolycrystalOptions{.grains = grains, .seed = seed});
  regularise(t, RegularisationOptions{});
  return t;
}

double mean_worst(const Mesh& mesh) {
  std::vector<double> worst(mesh.topology.cell_count(), 1.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& t = mesh.tetrahedra[e];
    double& w = worst[mesh.tetrahedron_cell[e]];
    w = std::min(
        w, radius_ratio(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]));
  }
  return std::accumulate(worst.begin(), worst.end(), 0.0) / static_cast<double>(worst.size());
}

class BoundarySliding : public testing::Test {
 protected:
  Mesh mesh(const Geometry& geometry, MeshingOptions options, const Vec3& scale = Vec3::Ones()) {
    MeshingReport report;
    options.meshers = {"gmsh-hxt"};
    return mesh_geometry(geometry, options, scale, *pool_, report);
  }

  std::unique_ptr<MesherPool> pool_ = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
};

// All faces of the body are in pairs: without those that slide together little would.
TEST_F(BoundarySliding, MovesTranslatesTogether) {
  PolycrystalOptions polycrystal{.grains = 12, .seed = 3};
  polycrystal.periodic = {true, true, true};
  auto t = voronoi_tessellation(polycrystal);
  regularise(t, {});
  const auto geometry = geometry_of(t);
  MeshingOptions options;
  options.element_size = 0.4;
  options.slide_boundary = false;
  const Mesh before = mesh(geometry, options);
  options.slide_boundary = true;
  const Mesh after = mesh(geometry, options);
  ASSERT_NO_THROW(check(after));
  EXPECT_GT(mean_worst(after), mean_worst(before) + 0.02);
  EXPECT_GE(quality(after).min_radius_ratio, quality(before).min_radius_ratio);
  int moved = 0;
  for (const auto& pair : after.periodic_nodes) {
    EXPECT_EQ(after.nodes[pair.slave],
              translated(after.nodes[pair.master], pair.shift, after.size));
    moved += after.nodes[pair.slave] != before.nodes[pair.slave];
  }
  EXPECT_GT(moved, static_cast<int>(after.periodic_nodes.size()) / 2);
  for (const int jobs : {1, 3}) {
    options.jobs = jobs;
    EXPECT_EQ(mesh(geometry, options).nodes, after.nodes);
  }
}

TEST_F(BoundarySliding, RaisesTheWorstElementsOfGrainsAndKeepsTheBox) {
  const auto tessellation = polycrystal(40, 3);
  const auto geometry = geometry_of(tessellation);
  MeshingOptions options;
  options.element_size = 0.35;
  options.slide_boundary = false;
  const Mesh before = mesh(geometry, options);
  options.slide_boundary = true;
  const Mesh after = mesh(geometry, options);
  ASSERT_NO_THROW(check(after));
  EXPECT_GT(mean_worst(after), mean_worst(before) + 0.02);
  EXPECT_GE(quality(after).min_radius_ratio, quality(before).min_radius_ratio);
  EXPECT_GT(quality(after).mean_radius_ratio, quality(before).mean_radius_ratio);
  const auto volumes = grain_volumes(after);
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0) / 40, 1, 1e-12);
  for (int c = 0; c < 40; ++c) EXPECT_NEAR(volumes[c], cell_volume(tessellation, c), 0.02);
  // Vertices stay, domain faces are planes to the last bit.
  for (int v = 0; v < tessellation.topology.vertex_count; ++v)
    EXPECT_EQ(after.nodes[after.vertex_nodes[v]], before.nodes[before.vertex_nodes[v]]);
  int on_domain = 0, moved = 0;
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    for (int n : before.triangles[t]) moved += before.nodes[n] != after.nodes[n];
    const int domain = after.topology.faces[after.triangle_face[t]].domain_face;
    if (domain < 0) continue;
    ++on_domain;
    for (int n : after.triangles[t])
      EXPECT_EQ(after.nodes[n][domain / 2], domain % 2 == 0 ? 0.0 : after.size[domain / 2]);
  }
  EXPECT_GT(on_domain, 0);
  EXPECT_GT(moved, 0);
}

TEST_F(BoundarySliding, KeepsTheProgressionAlongEdges) {
  const auto geometry = geometry_of(polycrystal(20, 5));
  MeshingOptions options;
  options.element_size = 0.25;
  options.progression_factor = 1.5;
  const Mesh m = mesh(geometry, options);
  int pairs = 0;
  for (std::size_t l = 1; l < m.lines.size(); ++l) {
    if (m.line_edge[l] != m.line_edge[l - 1]) continue;
    const auto length = [&](std::size_t i) {
      return (m.nodes[m.lines[i][1]] - m.nodes[m.lines[i][0]]).norm();
    };
    const double ratio = length(l) / length(l - 1);
    EXPECT_LE(std::max(ratio, 1 / ratio), 1.5 * (1 + 1e-8));
    ++pairs;
  }
  EXPECT_GT(pairs, 100);
}

TEST_F(BoundarySliding, KeepsTheProgressionAcrossVertices) {
  for (const double size : {0.5, 0.25}) {
    const auto geometry = geometry_of(polycrystal(20, 5));
    MeshingOptions options;
    options.element_size = size;
    const Mesh m = mesh(geometry, options);
    const auto length = [&](std::size_t i) {
      return (m.nodes[m.lines[i][1]] - m.nodes[m.lines[i][0]]).norm();
    };
    std::vector<double> least(m.topology.vertex_count, 1e9), most(m.topology.vertex_count, 0);
    for (std::size_t l = 0; l < m.lines.size(); ++l)
      for (int i = 0; i < 2; ++i)
        for (int v : m.topology.edges[m.line_edge[l]].vertices)
          if (m.lines[l][i] == m.vertex_nodes[v]) {
            least[v] = std::min(least[v], length(l));
            most[v] = std::max(most[v], length(l));
          }
    double worst = 0;
    for (std::size_t v = 0; v < least.size(); ++v) {
      EXPECT_LE(most[v], 2 * least[v] * (1 + 1e-8));
      worst = std::max(worst, most[v] / least[v]);
    }
    EXPECT_GT(worst, 1.5);
  }
}

/// Grains' meshes before they are put together.
struct Parts {
  Geometry geometry;
  std::unique_ptr<BoundaryMesher> boundary;
  std::vector<VolumeMesh> volumes;

  double worst(std::size_t grain) const { return min_radius_ratio(volumes[grain]); }
};

Parts slid_grains(const Geometry& geometry, MesherPool& pool, double element_size) {
  Parts parts{geometry, nullptr, {}};
  MeshingOptions options;
  options.element_size = element_size;
  parts.boundary = std::make_unique<BoundaryMesher>(geometry, options, Vec3::Ones());
  parts.boundary->update();
  const auto numbers = parts.boundary->numbers();
  const auto positions = parts.boundary->positions(numbers);
  std::vector<GrainRequest> requests;
  for (int grain = 0; grain < geometry.topology.cell_count(); ++grain)
    requests.push_back(
        {grain,
         grain_surface(geometry.topology, *parts.boundary, numbers, positions, grain, Vec3::Ones())
             .mesh,
         element_size});
  PoolOptions pool_options;
  pool_options.meshers = {"gmsh-hxt"};
  pool_options.element_size = element_size;
  for (auto& result : pool.mesh(requests, pool_options))
    parts.volumes.push_back(std::move(result.mesh));
  slide_boundary(*parts.boundary, parts.volumes, options.progression_factor, 2);
  return parts;
}

TEST_F(BoundarySliding, RaisesTheWorstElementsAndLeavesOtherGrains) {
  const auto geometry = geometry_of(polycrystal(60, 2));
  const Parts before = slid_grains(geometry, *pool_, 0.4);
  Parts after = slid_grains(geometry, *pool_, 0.4);
  raise_worst(*after.boundary, after.volumes, 2, 2);
  double least_before = 1, least_after = 1;
  int bad = 0, raised = 0, same = 0;
  for (std::size_t g = 0; g < before.volumes.size(); ++g) {
    least_before = std::min(least_before, before.worst(g));
    least_after = std::min(least_after, after.worst(g));
    EXPECT_GE(after.worst(g), std::min(0.3, before.worst(g)) - 1e-12) << g;
    bad += before.worst(g) < 0.3;
    raised += before.worst(g) < 0.3 && after.worst(g) > before.worst(g) + 0.01;
    same += before.volumes[g].nodes == after.volumes[g].nodes;
  }
  EXPECT_LT(least_before, 0.25);
  EXPECT_GT(least_after, least_before + 0.03);
  EXPECT_GT(bad, 5);
  EXPECT_GT(raised, bad / 2);
  EXPECT_GT(same, 0);
}

/// By all meshers of the default each grain has a second candidate: its mesh optimised once nodes
/// have slid only.
TEST_F(BoundarySliding, TakesTheBetterOfTwoOrdersOfOptimising) {
  const auto geometry = geometry_of(polycrystal(60, 6));
  MeshingOptions options;
  options.element_size = 0.35;
  MeshingReport all, hxt, plain;
  check(mesh_geometry(geometry, options, Vec3::Ones(), *pool_, all));
  options.meshers = {"gmsh-hxt"};
  mesh_geometry(geometry, options, Vec3::Ones(), *pool_, hxt);
  options.meshers = {"gmsh-hxt-plain"};
  mesh_geometry(geometry, options, Vec3::Ones(), *pool_, plain);
  EXPECT_GT(all.mean_O, std::max(hxt.mean_O, plain.mean_O));
  EXPECT_GE(all.wins[0], 55);
}

/// Each mesher tries the grain, one of twenty, with the worst element once more, as long as its
/// surface allows a better one.
TEST_F(BoundarySliding, LetsOtherMeshersHaveTheWorstGrains) {
  const auto by = [&](const std::string& mesher, std::vector<std::size_t>* counts) -> GrainMeshers {
    PoolOptions options;
    options.meshers = {mesher};
    return [this, options, counts](std::size_t count, const RequestSource& source,
                                   const ResultSink& sink) {
      if (counts) counts->push_back(count);
      pool_->mesh(count, source, sink, options);
    };
  };
  for (const std::uint64_t seed : {5, 9}) {
    const auto geometry = geometry_of(polycrystal(20, seed));
    MeshingReport report;
    const auto first = by("paper-1", nullptr);
    TurnsOfMeshers turns{first, {}};
    const auto worst = [&] {
      const Mesh m = mesh_geometry(geometry, {}, Vec3::Ones(), first, report, {}, turns);
      check(m);
      return quality(m).min_radius_ratio;
    };
    const double before = worst();
    std::vector<std::size_t> counts;
    for (const char* mesher : {"gmsh-hxt", "gmsh-delaunay"})
      turns.each.push_back(by(mesher, &counts));
    const double after = worst();
    const std::size_t asked = seed == 9 ? 1 : 0;  // in 5 all are at what their surfaces allow
    EXPECT_EQ(counts, (std::vector<std::size_t>{asked, asked}));
    if (asked == 0)
      EXPECT_EQ(after, before);
    else
      EXPECT_GT(after, before + 0.003);
  }
}

/// Of end elements on both sides of corners of faces below `limit` [rad]: longer by shorter.
std::vector<double> ratios_at_corners(const BoundaryMesher& boundary, double limit) {
  std::vector<double> ratios;
  for (const auto& face : boundary.geometry().topology.faces)
    for (std::size_t i = 0; i < face.edges.size(); ++i) {
      const std::size_t j = (i + 1) % face.edges.size();
      // From the corner to the next node on each side.
      auto before = boundary.edges()[face.edges[i]].nodes;
      auto after = boundary.edges()[face.edges[j]].nodes;
      if (face.forward[i]) std::reverse(before.begin(), before.end());
      if (!face.forward[j]) std::reverse(after.begin(), after.end());
      const Vec3 a = before[1] - before[0], b = after[1] - after[0];
      if (std::atan2(a.cross(b).norm(), a.dot(b)) < limit)
        ratios.push_back(std::max(a.norm() / b.norm(), b.norm() / a.norm()));
    }
  return ratios;
}

TEST_F(BoundarySliding, BeginsWithElementsAlikeAtAcuteCorners) {
  const auto geometry = geometry_of(polycrystal(500, 1));
  MeshingOptions options;
  options.element_size = 0.25;
  BoundaryMesher boundary(geometry, options, Vec3::Ones());
  boundary.update();
  auto ratios = ratios_at_corners(boundary, 9.9 * M_PI / 180);
  std::sort(ratios.begin(), ratios.end());
  ASSERT_GT(ratios.size(), 15u);
  EXPECT_LT(ratios.back(), 1.02 + 1e-9);
}

TEST_F(BoundarySliding, IsTheSameForAnyNumberOfThreads) {
  const auto geometry = geometry_of(polycrystal(30, 6));
  MeshingOptions options;
  options.jobs = 1;
  MeshingReport report;
  const Mesh one = mesh_geometry(geometry, options, Vec3::Ones(), *pool_, report);
  for (const int jobs : {2, 3}) {
    options.jobs = jobs;
    const Mesh other = mesh_geometry(geometry, options, Vec3::Ones(), *pool_, report);
    EXPECT_EQ(one.nodes, other.nodes);
    EXPECT_EQ(one.tetrahedra, other.tetrahedra);
  }
}

TEST_F(BoundarySliding, KeepsARemeshedGrainsVolume) {
  MeshingOptions options;
  Mesh old = mesh(geometry_of(polycrystal(20, 7)), options);
  for (auto& x : old.nodes) {
    x[0] += 0.08 * std::sin(2.9 * x[1]) * std::sin(3.1 * x[2]);
    x = x.cwiseProduct(Vec3(std::exp(0.3), 1, std::exp(-0.3)));
  }
  const auto before = grain_volumes(old);
  const Mesh fresh = mesh(geometry_of(old), options, Vec3(std::exp(-0.3), 1, std::exp(0.3)));
  ASSERT_NO_THROW(check(fresh));
  const auto after = grain_volumes(fresh);
  for (int c = 0; c < 20; ++c) EXPECT_NEAR(after[c] / before[c], 1, 5e-3);
}

TEST(StarMesh, KnowsEachNodesTetrahedraAndTheGradientOfTheirSum) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.3, 0.9}, {0.3, 0.2, -0.8}};
  StarMesh mesh(nodes, {{0, 1, 2, 3}, {0, 2, 1, 4}}, 4);
  EXPECT_EQ(mesh.star(0).size(), 2u);
  EXPECT_EQ(mesh.star(3).size(), 1u);
  constexpr double h = 1e-6;
  for (const int power : {3, 9})
    for (int i = 0; i < 3; ++i) {
      const auto d = star_descent(mesh, 0, power);
      mesh.move(0, nodes[0] + h * Vec3::Unit(i));
      const double up = star_descent(mesh, 0, power).sum;
      mesh.move(0, nodes[0] - h * Vec3::Unit(i));
      const double down = star_descent(mesh, 0, power).sum;
      mesh.move(0, nodes[0]);
      EXPECT_NEAR(d.gradient[i], (up - down) / (2 * h), 1e-5 * std::abs(d.sum));
    }
  const auto d = star_descent(mesh, 0);
  EXPECT_FALSE(star_improves(mesh, 0, Vec3(0.2, 0.3, 0.95), d));  // inverts
  EXPECT_FALSE(star_improves(mesh, 0, Vec3::Constant(std::nan("")), d));
}

}  // namespace
}  // namespace polyslip::mesh
