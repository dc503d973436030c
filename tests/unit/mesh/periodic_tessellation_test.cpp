#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "mesh/folded_tessellation.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Directions3 = std::array<bool, 3>;

const std::vector<Directions3> one_two_three{
    {true, false, false}, {false, true, true}, {true, true, true}};

Tessellation periodic(int grains, std::uint64_t seed, const Directions3& directions,
                      const Vec3& domain = {1, 1, 1}) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = seed;
  options.domain = domain;
  options.periodic = directions;
  return voronoi_tessellation(options);
}

/// Faces of the whole that are on no domain face come in pairs; grains on none are inner.
void expect_pairs(const Tessellation& t, const Directions3& directions) {
  const auto& p = t.topology.periodic;
  ASSERT_FALSE(p.empty());
  std::set<int> in_pairs;
  for (const auto& pair : p.faces) {
    in_pairs.insert({pair.slave, pair.master});
    EXPECT_FALSE(is_zero(pair.shift));
    for (int k = 0; k < 3; ++k) {
      if (!directions[k]) {
        EXPECT_EQ(pair.shift[k], 0);
      }
    }
    EXPECT_NEAR(flatness_fault(t, pair.slave), flatness_fault(t, pair.master), 1e-6);
  }
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) {
    const auto& face = t.topology.faces[f];
    EXPECT_EQ(face.cells[1] == -1, face.domain_face >= 0 || in_pairs.count(f) > 0);
    if (face.domain_face >= 0) {
      EXPECT_FALSE(directions[face.domain_face / 2]);
    }
  }
}

void expect_same(const Tessellation& p, const Tessellation& q) {
  EXPECT_EQ(p.vertices, q.vertices);
  EXPECT_EQ(p.topology.cell_faces, q.topology.cell_faces);
  EXPECT_EQ(p.face_masters, q.face_masters);
  ASSERT_EQ(p.topology.faces.size(), q.topology.faces.size());
  for (std::size_t f = 0; f < p.topology.faces.size(); ++f)
    EXPECT_EQ(p.topology.faces[f].edges, q.topology.faces[f].edges);
  ASSERT_EQ(p.topology.periodic.vertices.size(), q.topology.periodic.vertices.size());
}

TEST(PeriodicTessellation, GrainsAreWholeAndFillTheBox) {
  for (const auto& directions : one_two_three)
    for (const int grains : {2, 5, 20, 100}) {
      SCOPED_TRACE(::testing::Message() << grains << " grains");
      const auto t = periodic(grains, 3, directions);
      t.check();
      expect_pairs(t, directions);
      double volume = 0;
      for (int c = 0; c < grains; ++c) volume += cell_volume(t, c);
      EXPECT_NEAR(volume / t.size.prod(), 1, 1e-12);
    }
}

TEST(PeriodicTessellation, OneGrainIsABoxOrPartOfOne) {
  for (const auto& directions : one_two_three) {
    auto t = periodic(1, 1, directions, {1, 2, 3});
    t.check();
    expect_pairs(t, directions);
    EXPECT_EQ(t.topology.faces.size(), 6);
    EXPECT_EQ(t.topology.vertex_count, 8);
    RegularisationOptions options;
    options.max_edge_length = 1;
    EXPECT_EQ(regularise(t, options).deleted, 0);
    t.check();
  }
}

TEST(PeriodicTessellation, FoldingUndoesUnfolding) {
  for (const auto& directions : one_two_three) {
    const auto t = periodic(30, 4, directions);
    expect_same(t, unfold(fold(t)));
  }
}

// Each cell of a periodic Voronoi tessellation is simple: 2 E = 3 V, and V - E + F = 2.
TEST(PeriodicTessellation, CellsAreSimplePolyhedra) {
  const auto t = periodic(50, 5, {true, true, true});
  for (const auto& cell : t.topology.cell_faces) {
    std::set<int> edges, vertices;
    for (const int f : cell) {
      edges.insert(t.topology.faces[f].edges.begin(), t.topology.faces[f].edges.end());
      for (const int v : t.topology.face_vertices(f)) vertices.insert(v);
    }
    EXPECT_EQ(2 * edges.size(), 3 * vertices.size());
    EXPECT_EQ(vertices.size() + cell.size(), edges.size() + 2);
  }
}

// Moving all seeds moves the polycrystal.
TEST(PeriodicTessellation, WhereTheBoxBeginsDoesNotMatter) {
  Domain domain = box_domain({3, 3, 3});
  domain.periodic = {true, true, true};
  const auto t = periodic(27, 6, {true, true, true});
  auto moved = t.seeds;
  for (Vec3& x : moved)
    for (int k = 0; k < 3; ++k) x[k] = std::fmod(x[k] + 1.3 + k, 3.0);
  const auto u = voronoi_tessellation(moved, domain);
  u.check();
  for (int c = 0; c < 27; ++c) {
    EXPECT_NEAR(cell_volume(t, c), cell_volume(u, c), 1e-12);
    EXPECT_EQ(t.topology.cell_faces[c].size(), u.topology.cell_faces[c].size());
  }
}

TEST(PeriodicTessellation, RegularSeedsGiveRegularGrains) {
  Domain domain = box_domain({2, 2, 2});
  domain.periodic = {true, true, true};
  struct Case {
    std::vector<Vec3> seeds;
    std::size_t faces;
  };
  for (const auto& [seeds, faces] :
       {Case{{{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}}, 14},
        Case{{{0.5, 0.5, 0.5}, {1.5, 1.5, 0.5}, {1.5, 0.5, 1.5}, {0.5, 1.5, 1.5}}, 12}}) {
    auto t = voronoi_tessellation(seeds, domain);
    t.check();
    for (const auto& cell : t.topology.cell_faces) EXPECT_EQ(cell.size(), faces);
    RegularisationOptions options;
    options.max_edge_length = 0.2;
    EXPECT_EQ(regularise(t, options).deleted, 0);
  }
}

TEST(PeriodicRegularisation, LeavesSoundTessellations) {
  for (const auto& directions : one_two_three)
    for (const int grains : {2, 5, 20, 150})
      for (const double length : {0.13, 0.39}) {
        SCOPED_TRACE(::testing::Message() << grains << " grains, " << length);
        auto t = periodic(grains, 7, directions);
        RegularisationOptions options;
        options.max_edge_length = length;
        const auto report = regularise(t, options);
        t.check();
        expect_pairs(t, directions);
        EXPECT_LE(report.max_flatness_fault, 20 + 1e-9);
        EXPECT_EQ(report.refused.sum(), report.short_after);
        if (grains == 150) {
          EXPECT_GT(report.deleted, 0.6 * report.short_before);
        }
        auto again = t;
        EXPECT_EQ(regularise(again, options).deleted, 0);
        expect_same(t, again);
      }
}

// A grain next to the side of the box is regularised as any other: the result does not depend on
// where the box begins.
TEST(PeriodicRegularisation, WhereTheBoxBeginsDoesNotMatter) {
  const auto raw = periodic(64, 8, {true, true, true});
  auto t = raw;
  auto moved = t.seeds;
  for (Vec3& x : moved)
    for (int k = 0; k < 3; ++k) x[k] = std::fmod(x[k] + 2.0, 4.0);
  auto u = voronoi_tessellation(moved, raw.domain);
  const auto options = RegularisationOptions{}.as_in_the_paper();  // in no order of numbers
  regularise(t, options);
  regularise(u, options);
  double worst = 0;
  for (int c = 0; c < 64; ++c) {
    worst = std::max(worst, std::abs(cell_volume(t, c) - cell_volume(u, c)));
    EXPECT_EQ(t.topology.cell_faces[c].size(), u.topology.cell_faces[c].size());
  }
  EXPECT_LT(worst, 1e-9);
}

}  // namespace
}  // namespace polyslip::mesh
