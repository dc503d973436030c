#pragma once
// The smallest mesh of two grains: a tetrahedron each, sharing a face.

#include <map>
#include <utility>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Corners 0 ... 3 and 0, 2, 1, 4 of grains 0 and 1; straight, order 2.
inline Mesh two_tetrahedra() {
  Mesh m;
  m.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, -1}};
  std::map<std::pair<int, int>, int> mids;
  auto mid = [&](int a, int b) {
    const auto [it, added] = mids.try_emplace(std::minmax(a, b), static_cast<int>(m.nodes.size()));
    if (added) m.nodes.push_back((m.nodes[a] + m.nodes[b]) / 2);
    return it->second;
  };
  const std::array<std::array<int, 4>, 2> corners{{{0, 1, 2, 3}, {0, 2, 1, 4}}};
  const std::array<std::array<int, 3>, 4> facets{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  std::map<std::pair<int, int>, int> edges;
  auto& t = m.topology;
  t.vertex_count = 5;
  t.cell_faces.resize(2);
  auto add_face = [&](std::array<int, 3> loop, int cell, int other) {
    TopologyFace face;
    for (int i = 0; i < 3; ++i) {
      const int a = loop[i], b = loop[(i + 1) % 3];
      const auto [it, added] = edges.try_emplace(std::minmax(a, b), static_cast<int>(edges.size()));
      if (added) {
        t.edges.push_back({{a, b}});
        m.lines.push_back({a, b, mid(a, b)});
        m.line_edge.push_back(it->second);
      }
      face.edges.push_back(it->second);
      face.forward.push_back(t.edges[it->second].vertices[0] == a);
    }
    face.cells = {cell, other};
    face.domain_face = other < 0 ? static_cast<int>(t.faces.size() % 6) : -1;
    const int id = static_cast<int>(t.faces.size());
    t.cell_faces[cell].push_back(id);
    if (other >= 0) t.cell_faces[other].push_back(id);
    t.faces.push_back(face);
    m.triangles.push_back({loop[0], loop[1], loop[2], mid(loop[0], loop[1]), mid(loop[1], loop[2]),
                           mid(loop[2], loop[0])});
    m.triangle_face.push_back(id);
  };
  for (int c = 0; c < 2; ++c) {
    std::array<int, 10> tet{};
    for (int i = 0; i < 4; ++i) tet[i] = corners[c][i];
    for (int e = 0; e < 6; ++e)
      tet[4 + e] = mid(tet[tetrahedron_edges[e][0]], tet[tetrahedron_edges[e][1]]);
    m.tetrahedra.push_back(tet);
    m.tetrahedron_cell.push_back(c);
    for (int f = c; f < 4; ++f)
      add_face({tet[facets[f][0]], tet[facets[f][1]], tet[facets[f][2]]}, c,
               c == 0 && f == 0 ? 1 : -1);
  }
  for (int v = 0; v < 5; ++v) m.vertex_nodes.push_back(v);
  return m;
}

}  // namespace polyslip::mesh
