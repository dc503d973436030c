// Surfaces that are no discs, and what their parts must be.
#include "mesh/disc_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Triangle = std::array<int, 3>;

TriangleSurface joined(std::vector<Triangle> triangles) {
  TriangleSurface surface{std::move(triangles), {}};
  std::map<std::pair<int, int>, int> sides;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
      if (const auto other = sides.find({b, a}); other != sides.end())
        surface.joints.push_back({other->second, static_cast<int>(t)});
      sides[{a, b}] = static_cast<int>(t);
    }
  return surface;
}

struct Grid {
  TriangleSurface surface;
  std::vector<Vec3> nodes;
};

/// n x n squares of two triangles each, but for those that are `out`.
template <class Out>
Grid grid(int n, Out&& out) {
  Grid g;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) g.nodes.emplace_back(i, j, 0);
  std::vector<Triangle> triangles;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (out(i, j)) continue;
      const int a = i + (n + 1) * j, b = a + 1, c = a + n + 1, d = c + 1;
      triangles.push_back({a, b, d});
      triangles.push_back({a, d, c});
    }
  g.surface = joined(triangles);
  return g;
}

int count_of(const std::vector<int>& parts) {
  return 1 + *std::max_element(parts.begin(), parts.end());
}

/// Connected, V - E + F = 1, and a boundary that leaves each of its nodes once: a disc.
void expect_discs(const Grid& g, const std::vector<int>& parts) {
  ASSERT_EQ(parts.size(), g.surface.triangles.size());
  for (int p = 0; p < count_of(parts); ++p) {
    std::set<int> nodes, starts, reached;
    std::set<std::pair<int, int>> edges, directed;
    int faces = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) {
      if (parts[t] != p) continue;
      ++faces;
      for (int i = 0; i < 3; ++i) {
        const int a = g.surface.triangles[t][i], b = g.surface.triangles[t][(i + 1) % 3];
        nodes.insert(a);
        edges.insert(std::minmax(a, b));
        directed.insert({a, b});
      }
    }
    EXPECT_EQ(static_cast<int>(nodes.size() + faces) - static_cast<int>(edges.size()), 1) << p;
    for (const auto& [a, b] : directed)
      if (!directed.count({b, a})) {
        EXPECT_TRUE(starts.insert(a).second) << a;
      }
    reached.insert(*nodes.begin());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const auto& [a, b] : edges)
        if (reached.count(a) || reached.count(b)) reached.insert({a, b});
    EXPECT_EQ(reached, nodes) << p;
  }
}

TEST(DiscParts, ADiscStaysOne) {
  const Grid g = grid(5, [](int, int) { return false; });
  EXPECT_EQ(count_of(disc_parts(g.surface, g.nodes)), 1);
}

TEST(DiscParts, ARingIsCutInTwoHalves) {
  const Grid g = grid(9, [](int i, int j) { return i > 2 && i < 6 && j > 2 && j < 6; });
  const auto parts = disc_parts(g.surface, g.nodes);
  EXPECT_EQ(count_of(parts), 2);
  expect_discs(g, parts);
  const auto first = std::count(parts.begin(), parts.end(), 0);
  EXPECT_NEAR(static_cast<double>(first) / static_cast<double>(parts.size()), 0.5, 0.2);
}

TEST(DiscParts, SeveralHolesAndATouchingCorner) {
  const Grid holes = grid(9, [](int i, int j) { return i % 3 == 1 && j % 3 == 1; });
  expect_discs(holes, disc_parts(holes.surface, holes.nodes));
  // A hole whose corner touches the rim.
  const Grid pinched =
      grid(6, [](int i, int j) { return (i == 0 && j == 0) || (i == 1 && j == 1); });
  expect_discs(pinched, disc_parts(pinched.surface, pinched.nodes));
  EXPECT_GT(count_of(disc_parts(pinched.surface, pinched.nodes)), 1);
}

TEST(DiscParts, AClosedSurface) {
  Grid g;
  for (const double s : {-1.0, 1.0})
    for (int a = 0; a < 3; ++a) g.nodes.push_back(s * Vec3::Unit(a));
  g.surface = joined(
      {{3, 4, 5}, {4, 0, 5}, {0, 1, 5}, {1, 3, 5}, {4, 3, 2}, {0, 4, 2}, {1, 0, 2}, {3, 1, 2}});
  EXPECT_EQ(g.surface.joints.size(), 12U);
  const auto parts = disc_parts(g.surface, g.nodes);
  EXPECT_GT(count_of(parts), 1);
  expect_discs(g, parts);
}

TEST(DiscParts, UnconnectedSurfacesAreParts) {
  const Grid g = grid(7, [](int i, int) { return i == 3; });
  EXPECT_EQ(count_of(disc_parts(g.surface, g.nodes)), 2);
}

}  // namespace
}  // namespace polyslip::mesh
