#include "mesh/tessellation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

PolycrystalOptions options_of(int grains, std::uint64_t seed, const Vec3& domain = {1, 1, 1}) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = seed;
  options.domain = domain;
  return options;
}

double total_volume(const Tessellation& t) {
  double sum = 0;
  for (int c = 0; c < t.topology.cell_count(); ++c) sum += cell_volume(t, c);
  return sum;
}

void expect_sound(const Tessellation& t, int grains) {
  t.check();
  EXPECT_EQ(t.topology.cell_count(), grains);
  EXPECT_NEAR(t.size.prod() / grains, 1, 1e-12);
  EXPECT_NEAR(total_volume(t) / t.size.prod(), 1, 1e-12);
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f)
    EXPECT_LT(flatness_fault(t, f), 1e-4) << f;
}

/// Grid of n^3 seeds with the given points in each unit cell.
std::vector<Vec3> lattice(int n, const std::vector<Vec3>& basis) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const Vec3& b : basis) seeds.push_back(Vec3(i, j, k) + b);
  return seeds;
}

/// Numbers of faces of the cells that the boundary of the box does not change.
std::vector<int> unchanged_face_counts(const Tessellation& t) {
  std::vector<int> counts;
  for (int c = 0; c < t.topology.cell_count(); ++c)
    if (t.seeds[c].minCoeff() > 1 && (t.size - t.seeds[c]).minCoeff() > 1)
      counts.push_back(static_cast<int>(t.topology.cell_faces[c].size()));
  return counts;
}

TEST(BoxSize, HasTheShapeAndOneUnitOfVolumeAGrain) {
  const Vec3 size = box_size(options_of(30, 1, {2, 1, 0.5}));
  EXPECT_NEAR(size.prod(), 30, 1e-12);
  EXPECT_NEAR(size.x() / size.y(), 2, 1e-14);
  EXPECT_NEAR(size.z() / size.y(), 0.5, 1e-14);
}

TEST(BoxSize, RefusesWhatIsNoBox) {
  EXPECT_THROW(box_size(options_of(0, 1)), core::InputError);
  EXPECT_THROW(box_size(options_of(3, 1, {1, 0, 1})), core::InputError);
  EXPECT_THROW(box_size(options_of(3, 1, {1, -1, 1})), core::InputError);
  EXPECT_THROW(box_size(options_of(3, 1, {1, std::numeric_limits<double>::quiet_NaN(), 1})),
               core::InputError);
}

TEST(Voronoi, OneGrainIsTheBox) {
  const auto t = voronoi_tessellation(options_of(1, 1));
  expect_sound(t, 1);
  EXPECT_EQ(t.topology.vertex_count, 8);
  EXPECT_EQ(t.topology.edges.size(), 12U);
  ASSERT_EQ(t.topology.faces.size(), 6U);
  std::vector<int> faces;
  for (const auto& f : t.topology.faces) faces.push_back(f.domain_face);
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(faces, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(Voronoi, AnyNumberOfGrainsAndAnyShapeOfBox) {
  for (const int grains : {2, 3, 5, 30, 200}) {
    expect_sound(voronoi_tessellation(options_of(grains, 7)), grains);
    expect_sound(voronoi_tessellation(options_of(grains, 8, {1, 1, 1e-2})), grains);
    expect_sound(voronoi_tessellation(options_of(grains, 9, {30, 0.1, 1})), grains);
  }
}

TEST(Voronoi, PlanesAreHalfwayBetweenSeedsAndNormalsPointOutOfTheFirstCell) {
  const auto t = voronoi_tessellation(options_of(60, 3));
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) {
    const auto& face = t.topology.faces[f];
    const Plane& plane = t.face_planes[f];
    EXPECT_LT(plane.normal.dot(t.seeds[face.cells[0]]), plane.offset);
    if (face.cells[1] >= 0) {
      EXPECT_GT(plane.normal.dot(t.seeds[face.cells[1]]), plane.offset);
    }
    const auto loop = t.topology.face_vertices(f);
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3 &a = t.vertices[loop[i]], &b = t.vertices[loop[(i + 1) % loop.size()]];
      area += 0.5 * (a - t.seeds[0]).cross(b - t.seeds[0]);
      EXPECT_NEAR(plane.normal.dot(a), plane.offset, 1e-10);
    }
    EXPECT_GT(area.normalized().dot(plane.normal), 1 - 1e-6);
  }
}

TEST(Voronoi, EachVertexIsNearestToItsCells) {
  const auto t = voronoi_tessellation(options_of(60, 4));
  for (int c = 0; c < t.topology.cell_count(); ++c)
    for (const int f : t.topology.cell_faces[c])
      for (const int v : t.topology.face_vertices(f)) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& s : t.seeds) nearest = std::min(nearest, (s - t.vertices[v]).norm());
        EXPECT_NEAR((t.seeds[c] - t.vertices[v]).norm(), nearest, 1e-10);
      }
}

TEST(Voronoi, GenericVerticesJoinFourCellsAndEdgesThreeFaces) {
  const auto t = voronoi_tessellation(options_of(100, 5));
  std::vector<int> faces_of_edge(t.topology.edges.size(), 0);
  std::vector<char> inner(t.topology.edges.size(), 1);
  for (const auto& face : t.topology.faces)
    for (const int e : face.edges) {
      ++faces_of_edge[e];
      if (face.domain_face >= 0) inner[e] = 0;
    }
  int seen = 0;
  for (std::size_t e = 0; e < inner.size(); ++e)
    if (inner[e]) {
      EXPECT_EQ(faces_of_edge[e], 3);
      ++seen;
    }
  EXPECT_GT(seen, 300);
}

TEST(Voronoi, GridsOfSeedsGiveCubesTruncatedOctahedraAndRhombicDodecahedra) {
  struct Case {
    std::vector<Vec3> basis;
    int faces;
  };
  const std::vector<Case> cases{
      {{{0.5, 0.5, 0.5}}, 6},
      {{{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}}, 14},
      {{{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}}, 12}};
  for (const auto& c : cases) {
    const int n = 5;
    const auto t = voronoi_tessellation(lattice(n, c.basis), Vec3::Constant(n));
    t.check();
    EXPECT_NEAR(total_volume(t), n * n * n, 1e-10);
    const auto counts = unchanged_face_counts(t);
    ASSERT_GT(counts.size(), 20U);
    for (const int faces : counts) EXPECT_EQ(faces, c.faces);
  }
}

TEST(Voronoi, NearlyRegularSeedsStayConforming) {
  for (const double noise : {1e-15, 1e-12, 3e-12, 1e-11, 3e-11, 1e-10, 1e-9, 1e-8, 1e-6}) {
    auto seeds = lattice(4, {{0.5, 0.5, 0.5}});
    std::uint64_t state = 1;
    for (auto& s : seeds)
      for (int i = 0; i < 3; ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        s[i] += noise * (static_cast<double>(state >> 11) * 0x1.0p-53 - 0.5);
      }
    const auto t = voronoi_tessellation(seeds, Vec3::Constant(4));
    t.topology.check();
    EXPECT_NEAR(total_volume(t), 64, 1e-9) << noise;
  }
}

TEST(Voronoi, SameSeedSamePolycrystalOtherSeedAnother) {
  const auto a = voronoi_tessellation(options_of(40, 11)),
             b = voronoi_tessellation(options_of(40, 11));
  const auto c = voronoi_tessellation(options_of(40, 12));
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) EXPECT_EQ(a.vertices[i], b.vertices[i]);
  EXPECT_NE(a.seeds[0], c.seeds[0]);
}

TEST(Voronoi, RefusesSeedsOutsideTheBoxAndTwins) {
  EXPECT_THROW(voronoi_tessellation({}, Vec3(1, 1, 1)), core::InputError);
  EXPECT_THROW(voronoi_tessellation({{0.5, 0.5, 1.5}}, Vec3(1, 1, 1)), core::InputError);
  EXPECT_THROW(voronoi_tessellation({{0.5, 0.5, 0.5}}, Vec3(1, 0, 1)), core::InputError);
  EXPECT_THROW(voronoi_tessellation({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, Vec3(1, 1, 1)),
               core::InputError);
}

TEST(Tessellation, CheckRefusesMovedVerticesAndWrongSizes) {
  const auto t = voronoi_tessellation(options_of(20, 2));
  auto spoilt = t;
  spoilt.vertices.pop_back();
  EXPECT_THROW(spoilt.check(), core::InternalError);
  spoilt = t;
  spoilt.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(spoilt.check(), core::InternalError);
  spoilt = t;
  spoilt.face_masters[0] = 99;
  EXPECT_THROW(spoilt.check(), core::InternalError);
  spoilt = t;
  for (auto& x : spoilt.vertices) x *= 0.9;
  EXPECT_THROW(spoilt.check(), core::InternalError);
}

}  // namespace
}  // namespace polyslip::mesh
