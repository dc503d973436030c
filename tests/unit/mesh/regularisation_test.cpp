#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/error.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Tessellation voronoi(int grains, std::uint64_t seed, const Vec3& domain = {1, 1, 1}) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = seed;
  options.domain = domain;
  return voronoi_tessellation(options);
}

double edge_length(const Tessellation& t, int edge) {
  const auto [a, b] = t.topology.edges[edge].vertices;
  return (t.vertices[a] - t.vertices[b]).norm();
}

int short_edges(const Tessellation& t, double length) {
  int n = 0;
  for (int e = 0; e < static_cast<int>(t.topology.edges.size()); ++e)
    n += edge_length(t, e) < length;
  return n;
}

std::vector<Vec3> points_of(const Tessellation& t, int face) {
  std::vector<Vec3> points;
  for (const int v : t.topology.face_vertices(face)) points.push_back(t.vertices[v]);
  return points;
}

void expect_same(const Tessellation& p, const Tessellation& q) {
  ASSERT_EQ(p.topology.vertex_count, q.topology.vertex_count);
  ASSERT_EQ(p.topology.edges.size(), q.topology.edges.size());
  ASSERT_EQ(p.topology.faces.size(), q.topology.faces.size());
  EXPECT_EQ(p.topology.cell_faces, q.topology.cell_faces);
  EXPECT_EQ(p.face_masters, q.face_masters);
  for (std::size_t e = 0; e < p.topology.edges.size(); ++e)
    EXPECT_EQ(p.topology.edges[e].vertices, q.topology.edges[e].vertices);
  for (std::size_t f = 0; f < p.topology.faces.size(); ++f) {
    EXPECT_EQ(p.topology.faces[f].edges, q.topology.faces[f].edges);
    EXPECT_EQ(p.topology.faces[f].forward, q.topology.faces[f].forward);
  }
  for (std::size_t v = 0; v < p.vertices.size(); ++v) EXPECT_EQ(p.vertices[v], q.vertices[v]);
}

/// Cells are seen from their centroids: a test of its own, not that of the regularisation.
void expect_star_shaped(const Tessellation& t) {
  for (int c = 0; c < t.topology.cell_count(); ++c) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const int f : t.topology.cell_faces[c])
      for_each_fan_triangle(points_of(t, f), t.face_masters[f],
                            [&](const Vec3& a, const Vec3& b, const Vec3& m) {
                              if (t.topology.faces[f].cells[0] == c)
                                triangles.push_back({a, b, m});
                              else
                                triangles.push_back({b, a, m});
                            });
    double volume = 0;
    Vec3 centroid = Vec3::Zero();
    for (const auto& [a, b, m] : triangles) {
      const double part = a.dot(b.cross(m)) / 6;
      volume += part;
      centroid += part * (a + b + m) / 4;
    }
    centroid /= volume;
    for (const auto& [a, b, m] : triangles)
      ASSERT_GT((a - centroid).dot((b - centroid).cross(m - centroid)), 0) << "cell " << c;
  }
}

void expect_no_double_edges(const Tessellation& t) {
  std::set<std::pair<int, int>> ends;
  for (const auto& e : t.topology.edges)
    EXPECT_TRUE(ends.insert(std::minmax(e.vertices[0], e.vertices[1])).second);
}

void expect_box_corners(const Tessellation& t) {
  int corners = 0;
  for (const Vec3& x : t.vertices) {
    bool corner = true;
    for (int i = 0; i < 3; ++i) corner = corner && (x[i] == 0 || x[i] == t.size[i]);
    corners += corner;
  }
  EXPECT_EQ(corners, 8);
}

void expect_sound(const Tessellation& t, const RegularisationReport& report,
                  const RegularisationOptions& options) {
  t.check();
  double volume = 0, fault = 0;
  for (int c = 0; c < t.topology.cell_count(); ++c) {
    EXPECT_GE(t.topology.cell_faces[c].size(), 4U);
    volume += cell_volume(t, c);
  }
  EXPECT_NEAR(volume / t.size.prod(), 1, 1e-12);
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f)
    fault = std::max(fault, flatness_fault(t, f));
  EXPECT_LE(fault, options.max_flatness_fault + 1e-9);
  EXPECT_NEAR(report.max_flatness_fault, fault, 1e-6);
  EXPECT_EQ(report.short_after, short_edges(t, options.max_edge_length));
  expect_no_double_edges(t);
  expect_box_corners(t);
  expect_star_shaped(t);
}

TEST(Regularisation, LeavesSoundTessellationsWhateverTheNumberAndTheBox) {
  const RegularisationOptions options;
  for (const int grains : {1, 2, 3, 10, 100})
    for (const Vec3& domain : {Vec3(1, 1, 1), Vec3(1, 1, 0.01), Vec3(30, 0.1, 1)}) {
      auto t = voronoi(grains, 5, domain);
      const auto report = regularise(t, options);
      expect_sound(t, report, options);
    }
}

TEST(Regularisation, DeletesMostShortEdges) {
  auto t = voronoi(200, 1);
  const RegularisationOptions options;
  const auto edges = static_cast<int>(t.topology.edges.size());
  const int before = short_edges(t, options.max_edge_length);
  const auto report = regularise(t, options);
  expect_sound(t, report, options);
  EXPECT_EQ(report.edges_before, edges);
  EXPECT_EQ(report.short_before, before);
  ASSERT_GT(before, 200);
  EXPECT_LT(report.short_after, 0.15 * before);
  EXPECT_GT(report.deleted, 0.6 * before);
  EXPECT_GE(report.loops, 2);
  EXPECT_EQ(report.refused.sum(), report.short_after);
  EXPECT_GT(report.refused.flatness, 0);
  EXPECT_GT(report.refused.polyline, 0);
}

TEST(Regularisation, LargerLengthsAndFaultsStaySoundToo) {
  for (const double length : {0.26, 0.52, 1.0})
    for (const double fault : {2.0, 20.0, 60.0}) {
      RegularisationOptions options;
      options.max_edge_length = length;
      options.max_flatness_fault = fault;
      auto t = voronoi(60, 3);
      const auto report = regularise(t, options);
      expect_sound(t, report, options);
    }
}

TEST(Regularisation, ThePapersOwnLeavesNoPolylines) {
  auto t = voronoi(200, 2);
  const auto options = RegularisationOptions{}.as_in_the_paper();
  expect_sound(t, regularise(t, options), options);
  for (const auto& faces : t.topology.cell_faces) {
    std::map<int, int> faces_at;
    for (const int f : faces)
      for (const int v : t.topology.face_vertices(f)) ++faces_at[v];
    for (const auto& [vertex, n] : faces_at) EXPECT_GE(n, 3) << vertex;
  }
}

TEST(Regularisation, PolylinesRemoveTheShortestEdges) {
  RegularisationOptions with, without;
  without.polyline_share = without.min_corner_angle = 0;
  int left_with = 0, left_without = 0;
  for (int seed = 1; seed <= 5; ++seed) {
    auto p = voronoi(200, seed), q = p;
    regularise(p, with);
    regularise(q, without);
    left_with += short_edges(p, 0.026);
    left_without += short_edges(q, 0.026);
  }
  EXPECT_GT(left_without, 0);
  EXPECT_LT(left_with, left_without);
}

TEST(Regularisation, TwiceIsAsGoodAsOnce) {
  for (const double length : {0.13, 0.39})
    for (const bool paper : {false, true}) {
      RegularisationOptions options;
      options.max_edge_length = length;
      if (paper) options = options.as_in_the_paper();
      auto t = voronoi(300, 4);
      ASSERT_GT(regularise(t, options).deleted, 0);
      auto again = t;
      const auto report = regularise(again, options);
      EXPECT_EQ(report.deleted, 0);
      expect_same(t, again);
    }
}

// Fig. 5: the more distortion is allowed the fewer short edges stay, with convergence from about
// 20 degrees on.
TEST(Regularisation, FewerShortEdgesStayForLargerFaults) {
  const auto raw = voronoi(300, 8);
  std::vector<double> left;
  for (const double fault : {0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 45.0}) {
    RegularisationOptions options;
    options.max_flatness_fault = fault;
    auto t = raw;
    const auto report = regularise(t, options);
    expect_sound(t, report, options);
    left.push_back(static_cast<double>(report.short_after) / report.short_before);
  }
  EXPECT_EQ(left.front(), 1);
  for (std::size_t i = 1; i + 2 < left.size(); ++i) EXPECT_LT(left[i], left[i - 1]);
  EXPECT_LT(left[5], 0.15);
  EXPECT_NEAR(left[5], left[7], 0.05);
}

TEST(Regularisation, FlatteningLowersTheFaults) {
  RegularisationOptions with, without;
  without.flattening_sweeps = 0;
  auto p = voronoi(300, 9), q = p;
  expect_sound(p, regularise(p, with), with);
  regularise(q, without);
  const auto mean = [](const Tessellation& t) {
    double sum = 0;
    for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) sum += flatness_fault(t, f);
    return sum / static_cast<double>(t.topology.faces.size());
  };
  EXPECT_LT(mean(p), 0.95 * mean(q));
}

/// Seeds at n^3 cells of a grid, each with these points (in cells).
std::vector<Vec3> grid(int n, const std::vector<Vec3>& points) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const Vec3& p : points) seeds.push_back(Vec3(i, j, k) + p);
  return seeds;
}

TEST(Regularisation, RegularSeedsStaySound) {
  const std::vector<Vec3> simple{{0.5, 0.5, 0.5}};
  const std::vector<Vec3> body{{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}};
  const std::vector<Vec3> face{
      {0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
  for (const auto& points : {simple, body, face})
    for (const double length : {0.13, 0.3, 0.8}) {
      const double size = 3 * std::cbrt(static_cast<double>(points.size()));
      auto seeds = grid(3, points);
      for (Vec3& x : seeds) x *= size / 3;
      const auto raw = voronoi_tessellation(seeds, Vec3(size, size, size));
      RegularisationOptions options;
      options.max_edge_length = length;
      auto t = raw;
      const auto report = regularise(t, options);
      expect_sound(t, report, options);
      if (report.short_before == 0) expect_same(raw, t);
    }
}

TEST(Regularisation, SameInputSameResult) {
  auto p = voronoi(100, 6), q = voronoi(100, 6);
  regularise(p, {});
  regularise(q, {});
  expect_same(p, q);
}

TEST(Regularisation, NoLengthOrNoDistortionMeansNothing) {
  const auto raw = voronoi(100, 7);
  for (const auto& [length, fault] : {std::pair{0.0, 20.0}, std::pair{0.13, 0.0}}) {
    auto t = raw;
    RegularisationOptions options;
    options.max_edge_length = length;
    options.max_flatness_fault = fault;
    EXPECT_EQ(regularise(t, options).deleted, 0);
    expect_same(raw, t);
  }
}

TEST(Regularisation, RefusesOptionsOutOfRange) {
  auto t = voronoi(2, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double length : {-0.1, nan, std::numeric_limits<double>::infinity()}) {
    RegularisationOptions options;
    options.max_edge_length = length;
    EXPECT_THROW(regularise(t, options), core::InputError);
  }
  for (const double fault : {-1.0, 90.0, nan}) {
    RegularisationOptions options;
    options.max_flatness_fault = fault;
    EXPECT_THROW(regularise(t, options), core::InputError);
  }
  for (const double share : {-0.1, 1.1, nan}) {
    RegularisationOptions options;
    options.polyline_share = share;
    EXPECT_THROW(regularise(t, options), core::InputError);
  }
  for (const double search : {0.9, 4.1, nan}) {
    RegularisationOptions options;
    options.position_search = search;
    EXPECT_THROW(regularise(t, options), core::InputError);
  }
  RegularisationOptions options;
  options.flattening_sweeps = -1;
  EXPECT_THROW(regularise(t, options), core::InputError);
}

// Eq. (2): the sum of squared distances to the faces' planes has no slope at a new vertex. Only the
// shortest edge is deleted, so that there is one new vertex.
TEST(Regularisation, NewVertexIsTheLeastSquaresPoint) {
  int seen = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    auto t = voronoi(30, seed);
    const auto raw = t;
    double shortest = std::numeric_limits<double>::infinity();
    for (int e = 0; e < static_cast<int>(t.topology.edges.size()); ++e)
      shortest = std::min(shortest, edge_length(t, e));
    auto options = RegularisationOptions{}.as_in_the_paper();
    options.max_edge_length = shortest * (1 + 1e-9);
    if (regularise(t, options).deleted != 1) continue;
    for (int v = 0; v < t.topology.vertex_count; ++v) {
      const Vec3& x = t.vertices[v];
      if (std::find(raw.vertices.begin(), raw.vertices.end(), x) != raw.vertices.end()) continue;
      Vec3 slope = Vec3::Zero();
      for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) {
        const auto loop = t.topology.face_vertices(f);
        if (std::find(loop.begin(), loop.end(), v) == loop.end()) continue;
        const Plane& plane = t.face_planes[f];
        slope += plane.normal * (plane.normal.dot(x) - plane.offset);
      }
      for (int i = 0; i < 3; ++i)
        if (x[i] != 0 && x[i] != t.size[i]) {
          EXPECT_NEAR(slope[i], 0, 1e-3 * shortest);
        }
      ++seen;
    }
  }
  EXPECT_GT(seen, 5);
}

TEST(FaceFan, FlatnessFaultIsTheAngleBetweenTriangles) {
  // A square folded by 20 degrees about its diagonal 0-2.
  const double h = std::tan(20 * M_PI / 180) * std::sqrt(0.5);
  const std::vector<Vec3> loop{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, h}};
  EXPECT_NEAR(degrees_of_chord(fan_fault(loop, 0)), 20, 1e-9);
  EXPECT_NEAR(degrees_of_chord(fan_fault(loop, 2)), 20, 1e-9);
  EXPECT_NEAR(degrees_of_chord(chord_of_degrees(33)), 33, 1e-12);
}

TEST(FaceFan, TheBestMasterPointHasTheLeastFault) {
  const std::vector<Vec3> folded{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.3}};
  EXPECT_EQ(best_fan(folded).master, -1);
  EXPECT_LT(best_fan(folded).fault, fan_fault(folded, 0));
  // The barycentre does not see the whole of an arrow; its reflex corner does.
  const std::vector<Vec3> arrow{{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}, {0, 1, 0}};
  EXPECT_TRUE(best_fan(arrow).master == 0 || best_fan(arrow).master == 2);
  EXPECT_EQ(best_fan(arrow).fault, 0);
}

TEST(FaceFan, FoldedPolygonsAreSeen) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(unfolded_in_projection(square, -1));
  EXPECT_TRUE(unfolded_in_projection(square, 1));
  const std::vector<Vec3> bow{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.8, 1, 0}};
  EXPECT_FALSE(unfolded_in_projection(bow, -1));
  const std::vector<Vec3> arrow{{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}, {0, 1, 0}};
  EXPECT_FALSE(unfolded_in_projection(arrow, 1));
  EXPECT_TRUE(unfolded_in_projection(arrow, 2));
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_FALSE(unfolded_in_projection(line, -1));
}

}  // namespace
}  // namespace polyslip::mesh
