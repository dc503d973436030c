// Every invariant of a mesh, tested.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "mesh/mesh.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

namespace {

using core::InternalError;
using core::Vec3;

/// Facets of a positive tetrahedron, outward by the right-hand rule.
constexpr std::array<std::array<int, 3>, 4> outward_facets{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) {
  throw InternalError("mesh: " + fmt::format(text, std::forward<Args>(args)...));
}

template <class T>
void check_tags(const char* what, const std::vector<T>& entities, const std::vector<int>& tags,
                int count) {
  if (tags.size() != entities.size())
    fail("{} {} have {} tags", entities.size(), what, tags.size());
  if (!std::is_sorted(tags.begin(), tags.end())) fail("{} are not sorted by their tags", what);
  std::vector<bool> used(count, false);
  for (int tag : tags) {
    if (tag < 0 || tag >= count) fail("tag {} of {} is outside 0 ... {}", tag, what, count - 1);
    used[tag] = true;
  }
  for (int i = 0; i < count; ++i)
    if (!used[i]) fail("entity {} of the topology has no {}", i, what);
}

void check_arrays(const Mesh& m) {
  if (m.order != 1 && m.order != 2) fail("order {} is neither 1 nor 2", m.order);
  const auto& t = m.topology;
  check_tags("tetrahedra", m.tetrahedra, m.tetrahedron_cell, t.cell_count());
  check_tags("triangles", m.triangles, m.triangle_face, static_cast<int>(t.faces.size()));
  check_tags("lines", m.lines, m.line_edge, static_cast<int>(t.edges.size()));
  if (static_cast<int>(m.vertex_nodes.size()) != t.vertex_count)
    fail("{} vertex nodes for {} vertices", m.vertex_nodes.size(), t.vertex_count);
  for (int i = 0; i < m.node_count(); ++i)
    if (!m.nodes[i].allFinite()) fail("node {} is not finite", i);
}

/// Node numbers in range; mid nodes there or -1 as the order says; every node in a tetrahedron.
void check_node_numbers(const Mesh& m) {
  std::vector<bool> used(m.nodes.size(), false);
  auto check_entity = [&](const char* what, int id, auto& nodes, int corners, bool mark) {
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
      if (i >= corners && m.order == 1) {
        if (nodes[i] != -1) fail("{} {} of order 1 has mid node {}", what, id, nodes[i]);
        continue;
      }
      if (nodes[i] < 0 || nodes[i] >= m.node_count())
        fail("{} {} has node {} of {}", what, id, nodes[i], m.node_count());
      if (mark) used[nodes[i]] = true;
    }
  };
  for (int e = 0; e < m.element_count(); ++e)
    check_entity("tetrahedron", e, m.tetrahedra[e], 4, true);
  for (std::size_t i = 0; i < m.triangles.size(); ++i)
    check_entity("triangle", static_cast<int>(i), m.triangles[i], 3, false);
  for (std::size_t i = 0; i < m.lines.size(); ++i)
    check_entity("line", static_cast<int>(i), m.lines[i], 2, false);
  for (int n : m.vertex_nodes)
    if (n < 0 || n >= m.node_count()) fail("vertex node {} of {}", n, m.node_count());
  for (int i = 0; i < m.node_count(); ++i)
    if (!used[i]) fail("node {} is in no tetrahedron", i);
}

struct MidNode {
  std::array<int, 2> ends;
  int mid;
  auto operator<=>(const MidNode&) const = default;
};

/// One mid node for each edge of an element, and one edge for each mid node.
void check_mid_nodes(const Mesh& m) {
  if (m.order == 1) return;
  std::vector<MidNode> of_tetrahedra, of_others;
  auto add = [](std::vector<MidNode>& list, int a, int b, int mid) {
    list.push_back({{std::min(a, b), std::max(a, b)}, mid});
  };
  for (const auto& t : m.tetrahedra)
    for (int e = 0; e < 6; ++e)
      add(of_tetrahedra, t[tetrahedron_edges[e][0]], t[tetrahedron_edges[e][1]], t[4 + e]);
  std::sort(of_tetrahedra.begin(), of_tetrahedra.end());
  of_tetrahedra.erase(std::unique(of_tetrahedra.begin(), of_tetrahedra.end()), of_tetrahedra.end());
  std::vector<int> uses(m.nodes.size(), 0);
  for (std::size_t i = 0; i < of_tetrahedra.size(); ++i) {
    const auto& a = of_tetrahedra[i];
    if (i > 0 && of_tetrahedra[i - 1].ends == a.ends)
      fail("edge {}-{} has mid nodes {} and {}", a.ends[0], a.ends[1], of_tetrahedra[i - 1].mid,
           a.mid);
    if (uses[a.mid]++ > 0) fail("mid node {} is on more than one edge", a.mid);
  }
  for (const auto& t : m.tetrahedra)
    for (int i = 0; i < 4; ++i)
      if (uses[t[i]] > 0) fail("node {} is a corner and a mid node", t[i]);
  for (const auto& t : m.triangles)
    for (int e = 0; e < 3; ++e)
      add(of_others, t[triangle_edges[e][0]], t[triangle_edges[e][1]], t[3 + e]);
  for (const auto& l : m.lines) add(of_others, l[0], l[1], l[2]);
  for (const auto& a : of_others)
    if (!std::binary_search(of_tetrahedra.begin(), of_tetrahedra.end(), a))
      fail("edge {}-{} with mid node {} of a triangle or line is in no tetrahedron", a.ends[0],
           a.ends[1], a.mid);
}

struct Facet {
  std::array<int, 3> key;      ///< corners, sorted
  std::array<int, 3> corners;  ///< outward
  int element;
};

std::array<int, 3> sorted(std::array<int, 3> a) {
  std::sort(a.begin(), a.end());
  return a;
}

/// Whether b is a or one of its rotations.
bool same_orientation(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  for (int i = 0; i < 3; ++i)
    if (a[0] == b[i] && a[1] == b[(i + 1) % 3] && a[2] == b[(i + 2) % 3]) return true;
  return false;
}

/// Facet of one or two elements, and the triangle on it (-1: none).
void check_facet(const Mesh& m, const Facet* first, int count, int triangle) {
  const auto& key = first->key;
  if (count > 2) fail("facet {}-{}-{} is in {} tetrahedra", key[0], key[1], key[2], count);
  const int cell = m.tetrahedron_cell[first[0].element];
  const int other = count == 2 ? m.tetrahedron_cell[first[1].element] : -1;
  if (count == 2 && same_orientation(first[0].corners, first[1].corners))
    fail("tetrahedra {} and {} overlap: both lie on the same side of facet {}-{}-{}",
         first[0].element, first[1].element, key[0], key[1], key[2]);
  if (cell == other) {
    if (triangle >= 0) fail("triangle {} lies inside grain {}", triangle, cell);
    return;
  }
  if (triangle < 0)
    fail("facet {}-{}-{} between grains {} and {} (-1: outside) is no triangle of a face", key[0],
         key[1], key[2], cell, other);
  const auto& face = m.topology.faces[m.triangle_face[triangle]];
  const Facet* inner = face.cells[0] == cell ? first : first + 1;
  const bool matches = (face.cells[0] == cell && face.cells[1] == other) ||
                       (face.cells[1] == cell && face.cells[0] == other && count == 2);
  if (!matches)
    fail("triangle {} of face {} (grains {}, {}) lies between grains {} and {}", triangle,
         m.triangle_face[triangle], face.cells[0], face.cells[1], cell, other);
  const auto& t = m.triangles[triangle];
  if (!same_orientation({t[0], t[1], t[2]}, inner->corners))
    fail("triangle {} does not point out of grain {}", triangle, face.cells[0]);
}

void check_facets(const Mesh& m) {
  std::vector<Facet> facets;
  facets.reserve(m.tetrahedra.size() * 4);
  for (int e = 0; e < m.element_count(); ++e)
    for (const auto& f : outward_facets) {
      const auto& t = m.tetrahedra[e];
      const std::array<int, 3> corners{t[f[0]], t[f[1]], t[f[2]]};
      facets.push_back({sorted(corners), corners, e});
    }
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    return std::tie(a.key, a.element) < std::tie(b.key, b.element);
  });
  std::vector<std::pair<std::array<int, 3>, int>> triangles;
  for (std::size_t i = 0; i < m.triangles.size(); ++i) {
    const auto& t = m.triangles[i];
    triangles.push_back({sorted({t[0], t[1], t[2]}), static_cast<int>(i)});
  }
  std::sort(triangles.begin(), triangles.end());
  std::size_t next = 0;
  for (std::size_t i = 0; i < facets.size();) {
    std::size_t end = i;
    while (end < facets.size() && facets[end].key == facets[i].key) ++end;
    int triangle = -1;
    if (next < triangles.size() && triangles[next].first == facets[i].key)
      triangle = triangles[next++].second;
    check_facet(m, &facets[i], static_cast<int>(end - i), triangle);
    i = end;
  }
  if (next < triangles.size())
    fail("triangle {} is no facet of a tetrahedron, or is there twice", triangles[next].second);
}

/// Lines run from vertex to vertex of their edge, and bound the triangles of their faces.
void check_lines(const Mesh& m) {
  const auto& topology = m.topology;
  std::vector<std::vector<std::array<int, 2>>> of_edge(topology.edges.size());
  for (std::size_t i = 0; i < m.lines.size(); ++i)
    of_edge[m.line_edge[i]].push_back({m.lines[i][0], m.lines[i][1]});
  for (std::size_t e = 0; e < of_edge.size(); ++e) {
    int node = m.vertex_nodes[topology.edges[e].vertices[0]];
    for (const auto& line : of_edge[e]) {
      if (line[0] != node) fail("lines of edge {} do not follow each other at node {}", e, node);
      node = line[1];
    }
    if (node != m.vertex_nodes[topology.edges[e].vertices[1]])
      fail("lines of edge {} end at node {}, not at its vertex", e, node);
  }
  std::vector<std::vector<std::array<int, 2>>> boundary(topology.faces.size());
  for (std::size_t i = 0; i < m.triangles.size(); ++i)
    for (const auto& e : triangle_edges)
      boundary[m.triangle_face[i]].push_back({m.triangles[i][e[0]], m.triangles[i][e[1]]});
  for (std::size_t f = 0; f < boundary.size(); ++f) {
    auto& directed = boundary[f];
    std::sort(directed.begin(), directed.end());
    std::vector<std::array<int, 2>> open, expected;
    for (const auto& [a, b] : directed)
      if (!std::binary_search(directed.begin(), directed.end(), std::array<int, 2>{b, a}))
        open.push_back({a, b});
    const auto& face = topology.faces[f];
    for (std::size_t i = 0; i < face.edges.size(); ++i)
      for (const auto& [a, b] : of_edge[face.edges[i]])
        expected.push_back(face.forward[i] ? std::array<int, 2>{a, b} : std::array<int, 2>{b, a});
    std::sort(expected.begin(), expected.end());
    if (open != expected) fail("the triangles of face {} are not bounded by its edges' lines", f);
    if (std::adjacent_find(directed.begin(), directed.end()) != directed.end())
      fail("two triangles of face {} overlap at an edge", f);
  }
}

void check_jacobians(const Mesh& m) {
  std::vector<std::array<Vec3, 10>> gradients;
  for (const auto& q : tet_quadrature_4()) gradients.push_back(tet10_gradients(q.xi));
  for (const auto& q : tet_quadrature_15()) gradients.push_back(tet10_gradients(q.xi));
  for (int e = 0; e < m.element_count(); ++e) {
    const auto& t = m.tetrahedra[e];
    core::Mat3 straight;
    for (int i = 0; i < 3; ++i) straight.col(i) = m.nodes[t[i + 1]] - m.nodes[t[0]];
    if (!(straight.determinant() > 0))
      fail("tetrahedron {} of grain {} is not positive: det {}", e, m.tetrahedron_cell[e],
           straight.determinant());
    if (m.order == 1) continue;
    std::array<Vec3, 10> x;
    for (int i = 0; i < 10; ++i) x[i] = m.nodes[t[i]] - m.nodes[t[0]];
    for (std::size_t q = 0; q < gradients.size(); ++q) {
      const double det = tet10_jacobian(x, gradients[q]).determinant();
      if (!(det > 0))
        fail("tetrahedron {} of grain {} has det J = {} at point {} of the {}-point rule", e,
             m.tetrahedron_cell[e], det, q < 4 ? q : q - 4, q < 4 ? 4 : 15);
    }
  }
}

}  // namespace

void check(const Mesh& mesh) {
  if (mesh.tetrahedra.empty()) fail("there are no tetrahedra");
  check_arrays(mesh);
  check_node_numbers(mesh);
  check_mid_nodes(mesh);
  check_facets(mesh);
  check_lines(mesh);
  check_jacobians(mesh);
}

}  // namespace polyslip::mesh
