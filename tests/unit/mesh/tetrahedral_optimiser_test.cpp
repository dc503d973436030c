#include "mesh/tetrahedral_optimiser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>

#include "core/random.hpp"
#include "mesh/edge_removal.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesh/node_insertion.hpp"
#include "mesh/node_relocation.hpp"
#include "mesh/pipeline.hpp"
#include "mesh/tet_store.hpp"
#include "surfaces.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Tet = TetStore::Tet;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The facets that belong to one tetrahedron only, normals outward.
SurfaceMesh surface_of(const VolumeMesh& mesh, std::size_t nodes) {
  constexpr std::array<std::array<int, 3>, 4> facets{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  SurfaceMesh surface;
  surface.nodes.assign(mesh.nodes.begin(), mesh.nodes.begin() + static_cast<std::ptrdiff_t>(nodes));
  std::map<std::array<int, 3>, int> count;
  const auto sorted = [](std::array<int, 3> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  for (const auto& t : mesh.tetrahedra)
    for (const auto& f : facets) ++count[sorted({t[f[0]], t[f[1]], t[f[2]]})];
  for (const auto& t : mesh.tetrahedra)
    for (const auto& f : facets)
      if (count[sorted({t[f[0]], t[f[1]], t[f[2]]})] == 1)
        surface.triangles.push_back({t[f[0]], t[f[1]], t[f[2]]});
  return surface;
}

/// `count` tetrahedra around edge 0-1, the ring's nodes after these; shaken by `noise`.
VolumeMesh ring_mesh(int count, double height, double noise, core::Random& random) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, -height}, {0, 0, height}};
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    mesh.nodes.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.tetrahedra.push_back({0, 1, 2 + i, 2 + (i + 1) % count});
  }
  for (auto& x : mesh.nodes)
    for (int i = 0; i < 3; ++i) x[i] += noise * (2 * random.uniform() - 1);
  return mesh;
}

/// Octahedron about a node: 8 tetrahedra.
VolumeMesh octahedron(const Vec3& middle) {
  VolumeMesh mesh;
  mesh.nodes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, middle};
  for (const std::array<int, 3>& t : std::vector<std::array<int, 3>>{
           {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}})
    mesh.tetrahedra.push_back({6, t[0], t[1], t[2]});
  return mesh;
}

/// The largest least radius ratio over all triangulations of ring nodes i ... j, tried one by one.
double best_by_trial(const TetStore& store, const EdgeRing& ring, int i, int j) {
  if (j - i < 2) return infinity;
  double best = -infinity;
  for (int k = i + 1; k < j; ++k) {
    const auto& n = ring.nodes;
    const double own = std::min(store.quality_of({n[i], n[k], n[j], ring.b}),
                                store.quality_of({n[i], n[j], n[k], ring.a}));
    best = std::max(
        best, std::min({own, best_by_trial(store, ring, i, k), best_by_trial(store, ring, k, j)}));
  }
  return best;
}

TEST(TetStore, EvenPermutationsKeepTheSign) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      const std::array<int, 4> p{i, j, even_permutations[i][j][0], even_permutations[i][j][1]};
      int inversions = 0;
      for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b) {
          ASSERT_NE(p[a], p[b]);
          inversions += p[a] > p[b];
        }
      EXPECT_EQ(inversions % 2, 0) << i << j;
    }
}

TEST(EdgeRemoval, FindsTheBestTriangulationOfTheRing) {
  core::Random random(5, core::Stream::tests);
  int removed = 0;
  for (int count = 3; count <= max_ring; ++count)
    for (int trial = 0; trial < 40; ++trial) {
      const VolumeMesh mesh = ring_mesh(count, 0.7, 0.3, random);
      const double old = min_radius_ratio(mesh);
      if (!(old > 0)) continue;
      TetStore store(mesh, mesh.nodes.size());
      EdgeRing ring;
      ASSERT_TRUE(store.ring(0, 1, ring));
      ASSERT_EQ(ring.count, count);
      const double wanted = best_by_trial(store, ring, 0, count - 1);
      const bool done = remove_edge(store, 0, 1, 0);
      EXPECT_EQ(done, wanted > old) << count << " " << wanted << " " << old;
      const VolumeMesh result = store.mesh();
      EXPECT_EQ(min_radius_ratio(result), std::max(wanted, old));
      EXPECT_EQ(validate(surface_of(mesh, mesh.nodes.size()), result), "");
      EXPECT_EQ(static_cast<int>(result.tetrahedra.size()), done ? 2 * (count - 2) : count);
      removed += done;
    }
  EXPECT_GT(removed, 20);
}

TEST(EdgeRemoval, LeavesEdgesOfTheSurfaceAndLongRings) {
  core::Random random(5, core::Stream::tests);
  const VolumeMesh mesh = ring_mesh(5, 0.7, 0, random);
  TetStore store(mesh, 7);
  EXPECT_FALSE(remove_edge(store, 0, 2, -1));
  EXPECT_FALSE(remove_edge(store, 2, 3, -1));
  const VolumeMesh longer = ring_mesh(max_ring + 1, 0.01, 0, random);
  TetStore long_ring(longer, longer.nodes.size());
  EXPECT_FALSE(remove_edge(long_ring, 0, 1, -1));
  EXPECT_EQ(long_ring.mesh().tetrahedra, longer.tetrahedra);
}

TEST(EdgeRemoval, FlipsAFacetIfThreeTetrahedraAreBetter) {
  int flipped = 0;
  for (const double height : {0.1, 0.3, 0.5, 0.8, 1.2}) {
    VolumeMesh mesh;
    const double s = std::sqrt(0.75);
    mesh.nodes = {{1, 0, 0}, {-0.5, s, 0}, {-0.5, -s, 0}, {0, 0, height}, {0, 0, -height}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    const double two = min_radius_ratio(mesh);
    ASSERT_GT(two, 0);
    const double three = radius_ratio(mesh.nodes[4], mesh.nodes[3], mesh.nodes[0], mesh.nodes[1]);
    TetStore store(mesh, 5);
    EXPECT_EQ(flip_facet(store, 0, 3, 0), three > two);
    EXPECT_NEAR(min_radius_ratio(store.mesh()), std::max(two, three), 1e-14);
    EXPECT_EQ(validate(surface_of(mesh, 5), store.mesh()), "");
    EXPECT_FALSE(flip_facet(store, store.slot_count() - 1, 0, infinity));
    flipped += three > two;
  }
  EXPECT_GT(flipped, 0);
  EXPECT_LT(flipped, 5);
}

TEST(NodeRelocation, GradientIsThatOfTheRadiusRatio) {
  core::Random random(2, core::Stream::tests);
  int tried = 0;
  while (tried < 50) {
    std::array<Vec3, 4> x;
    for (auto& p : x)
      for (int i = 0; i < 3; ++i) p[i] = random.uniform();
    if (radius_ratio(x[0], x[1], x[2], x[3]) < 0.05) continue;
    ++tried;
    const Vec3 gradient = log_radius_ratio_gradient(x[0], x[1], x[2], x[3]);
    for (int i = 0; i < 3; ++i) {
      const auto at = [&](double step) {
        Vec3 moved = x[0];
        moved[i] += step;
        return std::log(radius_ratio(moved, x[1], x[2], x[3]));
      };
      constexpr double step = 1e-6;
      EXPECT_NEAR((at(step) - at(-step)) / (2 * step), gradient[i], 1e-4 * (1 + gradient.norm()));
    }
  }
}

TEST(NodeRelocation, BringsANodeToTheMiddle) {
  const VolumeMesh mesh = octahedron(Vec3(0.3, -0.35, 0.2));
  TetStore store(mesh, 6);
  double least = store.star_quality(6);
  for (int i = 0; i < 40 && relocate(store, 6); ++i) {
    EXPECT_GE(store.star_quality(6), least);
    least = store.star_quality(6);
  }
  EXPECT_LT(store.position(6).norm(), 0.02);
}

TEST(NodeRelocation, SplitsAnEdgeOnlyIfThatHelps) {
  core::Random random(5, core::Stream::tests);
  const VolumeMesh tall = ring_mesh(6, 2.0, 0.05, random);
  TetStore store(tall, tall.nodes.size());
  EXPECT_TRUE(split_edge(store, 0, 1, 0.03));
  EXPECT_GT(min_radius_ratio(store.mesh()), min_radius_ratio(tall) + 0.03);
  EXPECT_EQ(store.mesh().nodes.size(), tall.nodes.size() + 1);
  EXPECT_EQ(validate(surface_of(tall, tall.nodes.size()), store.mesh()), "");

  const VolumeMesh fit = ring_mesh(5, 0.6, 0.02, random);
  TetStore kept(fit, fit.nodes.size());
  EXPECT_FALSE(split_edge(kept, 0, 1, 0.03));
  EXPECT_EQ(kept.mesh().nodes.size(), fit.nodes.size());
  EXPECT_EQ(min_radius_ratio(kept.mesh()), min_radius_ratio(fit));
  EXPECT_FALSE(split_edge(kept, 0, 2, -1));  // on the surface
}

TEST(NodeRelocation, CollapsesANodeNextToTheSurface) {
  const VolumeMesh mesh = octahedron(Vec3(0.9, 0.03, 0.02));
  TetStore store(mesh, 6);
  ASSERT_TRUE(collapse_node(store, 6, 0.03));
  const VolumeMesh result = store.mesh();
  EXPECT_EQ(result.nodes.size(), 6U);
  EXPECT_EQ(validate(surface_of(mesh, 6), result), "");
  EXPECT_GT(min_radius_ratio(result), min_radius_ratio(mesh) + 0.03);
  EXPECT_FALSE(collapse_node(store, 6, 0.03));
  EXPECT_FALSE(collapse_node(store, 0, -1));  // on the surface
}

TEST(NodeInsertion, PutsANodeWhereThatHelps) {
  core::Random random(5, core::Stream::tests);
  const VolumeMesh tall = ring_mesh(6, 2.0, 0.05, random);
  TetStore store(tall, tall.nodes.size());
  ASSERT_TRUE(insert_node(store, 2, 0.03, 9));
  const VolumeMesh result = store.mesh();
  EXPECT_GT(min_radius_ratio(result), store.quality_of(tall.tetrahedra[2]) + 0.03);
  EXPECT_EQ(result.nodes.size(), tall.nodes.size() + 1);
  EXPECT_EQ(validate(surface_of(tall, tall.nodes.size()), result), "");
}

TEST(NodeInsertion, LeavesAsItIsWhatItCannotHelp) {
  core::Random random(5, core::Stream::tests);
  const VolumeMesh fit = ring_mesh(5, 0.6, 0.02, random);
  TetStore store(fit, fit.nodes.size());
  EXPECT_FALSE(insert_node(store, 2, 0.03, 9));
  const VolumeMesh result = store.mesh();
  EXPECT_EQ(result.nodes, fit.nodes);
  EXPECT_EQ(min_radius_ratio(result), min_radius_ratio(fit));
  EXPECT_EQ(validate(surface_of(fit, fit.nodes.size()), result), "");
}

TEST(NodeInsertion, TakesAwayNodesInTheHole) {
  const VolumeMesh mesh = octahedron(Vec3(0.93, 0.02, 0.01));
  TetStore store(mesh, 6);
  int worst = 0;
  for (int t = 1; t < store.slot_count(); ++t)
    if (store.quality(t) < store.quality(worst)) worst = t;
  ASSERT_TRUE(insert_node(store, worst, 0.2, 9));
  const VolumeMesh result = store.mesh();
  EXPECT_GT(min_radius_ratio(result), min_radius_ratio(mesh) + 0.2);
  EXPECT_EQ(validate(surface_of(mesh, 6), result), "");
  EXPECT_FALSE(store.is_free(6));
}

TEST(NodeRelocation, WithAHigherPowerRaisesTheLeastFurther) {
  const VolumeMesh mesh = octahedron(Vec3(0.3, -0.35, 0.2));
  std::array<double, 2> least{};
  for (const int power : {3, 9}) {
    VolumeMesh taller = mesh;
    taller.nodes[4] = Vec3(0.6, 0.2, 2.5);
    TetStore store(taller, 6);
    for (int i = 0; i < 200 && relocate(store, 6, power); ++i) {
    }
    least[power == 9] = store.star_quality(6);
  }
  EXPECT_GT(least[1], least[0] + 1e-3);
}

/// Four nodes of an octahedron's equator, hardly out of its plane, between two on either side.
TEST(TetrahedralOptimiser, RemovesASliver) {
  for (const double bend : {1e-9, 1e-3, 0.05}) {
    VolumeMesh mesh;
    mesh.nodes = {{1, 0, bend},   {0, 1, -bend}, {-1, 0, bend},
                  {0, -1, -bend}, {0, 0, 1},     {0, 0, -1}};
    mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 3, 4}, {1, 0, 3, 5}, {2, 1, 3, 5}, {0, 2, 1, 3}};
    const SurfaceMesh surface = surface_of(mesh, 6);
    ASSERT_EQ(validate(surface, mesh), "");
    ASSERT_LT(min_radius_ratio(mesh), 0.2);
    const VolumeMesh result = optimise_inside(surface, mesh);
    EXPECT_EQ(validate(surface, result), "");
    EXPECT_GT(min_radius_ratio(result), 0.6);
  }
}

TEST(TetrahedralOptimiser, RaisesTheWorstAndLeavesTheRest) {
  core::Random random(5, core::Stream::tests);
  const VolumeMesh tall = ring_mesh(6, 2.0, 0.05, random);
  const SurfaceMesh surface = surface_of(tall, tall.nodes.size());
  const double worst = min_radius_ratio(tall);
  EXPECT_EQ(raise_worst_inside(surface, tall, worst, 9).tetrahedra, tall.tetrahedra);
  const VolumeMesh result = raise_worst_inside(surface, tall, 0.6, 9);
  EXPECT_EQ(validate(surface, result), "");
  EXPECT_GT(min_radius_ratio(result), worst + 0.03);
}

bool identical(const VolumeMesh& a, const VolumeMesh& b) {
  return a.nodes.size() == b.nodes.size() && a.tetrahedra == b.tetrahedra &&
         std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), [](auto& x, auto& y) {
           return std::memcmp(x.data(), y.data(), 3 * sizeof(double)) == 0;
         });
}

struct Sums {
  double radius_ratio = 0, worst = 0;
  std::size_t elements = 0;
  void add(const VolumeMesh& mesh) {
    for (const auto& t : mesh.tetrahedra)
      radius_ratio += polyslip::mesh::radius_ratio(mesh.nodes[t[0]], mesh.nodes[t[1]],
                                                   mesh.nodes[t[2]], mesh.nodes[t[3]]);
    elements += mesh.tetrahedra.size();
    worst += min_radius_ratio(mesh);
  }
  double mean() const { return radius_ratio / static_cast<double>(elements); }
};

/// Real grains, as one mesher gives them with and without our optimiser.
TEST(TetrahedralOptimiser, ImprovesTheGrainsOfAPolycrystal) {
  constexpr int grains = 30;
  const std::string mesher = "gmsh-hxt";
  std::string unoptimised;
  for (int i = 0; i < grains; ++i)
    unoptimised += mesher + ":" + std::to_string(i) + ":unoptimised,";
  const std::string worker = POLYSLIP_BINARY_DIR "/polyslip-mesher";
  const auto pool = MesherPool::start(worker);
  setenv("POLYSLIP_MESHER_FAULT", unoptimised.c_str(), 1);
  const auto raw_pool = MesherPool::start(worker);
  unsetenv("POLYSLIP_MESHER_FAULT");

  auto tessellation = voronoi_tessellation(PolycrystalOptions{.grains = grains, .seed = 1});
  regularise(tessellation, RegularisationOptions{});
  MeshingOptions options;
  options.element_size = 0.35;
  options.order = 1;
  Sums before, after;
  const auto both = [&](const std::vector<GrainRequest>& requests) {
    PoolOptions pool_options;
    pool_options.meshers = {mesher};
    pool_options.element_size = options.element_size;
    const auto raw = raw_pool->mesh(requests, pool_options);
    auto optimised = pool->mesh(requests, pool_options);
    EXPECT_EQ(requests.size(), static_cast<std::size_t>(grains));
    for (std::size_t i = 0; i < requests.size(); ++i) {
      EXPECT_TRUE(raw[i].ok && optimised[i].ok);
      const VolumeMesh own = optimise_inside(requests[i].surface, raw[i].mesh);
      EXPECT_TRUE(identical(own, optimised[i].mesh)) << i;
      EXPECT_TRUE(identical(own, optimise_inside(requests[i].surface, raw[i].mesh))) << i;
      EXPECT_EQ(validate(requests[i].surface, own), "") << i;
      EXPECT_GE(min_radius_ratio(own), min_radius_ratio(raw[i].mesh)) << i;
      before.add(raw[i].mesh);
      after.add(own);
    }
    return optimised;
  };
  MeshingReport report;
  const Mesh mesh =
      mesh_geometry(geometry_of(tessellation), options, Vec3::Ones(), test::at_once(both), report);
  ASSERT_NO_THROW(check(mesh));
  EXPECT_GT(after.mean(), before.mean() + 0.01);
  EXPECT_GT(after.worst / grains, before.worst / grains + 0.02);
}

}  // namespace
}  // namespace polyslip::mesh
