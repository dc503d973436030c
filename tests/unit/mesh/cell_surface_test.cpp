// Surfaces of one cell, and what is wrong with them.
#include "mesh/cell_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace polyslip::mesh {
namespace {

using Kind = SurfaceFault::Kind;
using Loops = std::vector<std::vector<int>>;

/// A cell by the vertices of its faces, in order, seen from outside.
Topology cell(const Loops& loops) {
  Topology t;
  t.cell_faces.resize(1);
  for (const auto& loop : loops) {
    TopologyFace face;
    face.cells = {0, -1};
    face.domain_face = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const auto same = [&](const TopologyEdge& e) {
        return std::minmax(e.vertices[0], e.vertices[1]) == std::minmax(a, b);
      };
      auto edge = std::find_if(t.edges.begin(), t.edges.end(), same);
      if (edge == t.edges.end()) edge = t.edges.insert(edge, TopologyEdge{{a, b}});
      face.edges.push_back(static_cast<int>(edge - t.edges.begin()));
      face.forward.push_back(edge->vertices[0] == a);
      t.vertex_count = std::max(t.vertex_count, a + 1);
    }
    t.cell_faces[0].push_back(static_cast<int>(t.faces.size()));
    t.faces.push_back(face);
  }
  return t;
}

/// The sides between one triangle and the next of this list.
void add_storeys(const std::vector<std::array<int, 3>>& triangles, Loops& loops) {
  for (std::size_t k = 0; k + 1 < triangles.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      loops.push_back({triangles[k][i], triangles[k][j], triangles[k + 1][j], triangles[k + 1][i]});
    }
}

/// A prism of three storeys on the triangle 0 1 2 with this top.
Loops prism(const std::array<int, 3>& top) {
  Loops loops{{0, 2, 1}, {top[0], top[1], top[2]}};
  add_storeys({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, top}, loops);
  return loops;
}

TEST(CellSurface, ASphere) {
  EXPECT_EQ(surface_fault(cell(prism({9, 10, 11})), 0).kind, Kind::none);
  EXPECT_EQ(surface_fault(cell({{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}), 0).kind, Kind::none);
}

TEST(CellSurface, ATunnelIsNoFault) {
  // Three storeys bent round to a ring, without bottom and top.
  Loops ring;
  add_storeys({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 1, 2}}, ring);
  EXPECT_EQ(surface_fault(cell(ring), 0).kind, Kind::none);
}

TEST(CellSurface, FaultsAreNamed) {
  const SurfaceFault touching = surface_fault(cell(prism({0, 10, 11})), 0);
  EXPECT_EQ(touching.kind, Kind::touching);
  EXPECT_EQ(touching.where, 0);
  Loops open = prism({9, 10, 11});
  open.pop_back();
  EXPECT_EQ(surface_fault(cell(open), 0).kind, Kind::edge_not_shared);
  Loops turned = prism({9, 10, 11});
  std::reverse(turned[0].begin(), turned[0].end());
  EXPECT_EQ(surface_fault(cell(turned), 0).kind, Kind::turned_about);
  Loops two = prism({9, 10, 11});
  for (auto loop : prism({9, 10, 11})) {
    for (int& v : loop) v += 12;
    two.push_back(loop);
  }
  const SurfaceFault parts = surface_fault(cell(two), 0);
  EXPECT_EQ(parts.kind, Kind::parts);
  EXPECT_EQ(parts.where, 2);
}

}  // namespace
}  // namespace polyslip::mesh
