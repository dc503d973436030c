// Every invariant of a mesh, tested.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "core/error.hpp"
#include "mesh/blocks.hpp"
#include "mesh/curvature_bound.hpp"
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

/// Lists by node, one after the other in one array.
template <class Item>
class ListsByNode {
 public:
  /// `visit(index, add)` calls add(node, item) for each item of entity `index` of [0, count).
  template <class Visit>
  ListsByNode(int threads, std::size_t nodes, std::size_t count, const Visit& visit)
      : first_(nodes + 1, 0) {
    for_blocks(threads, count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        visit(i, [&](int node, const Item&) { next(node + 1); });
    });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    items_.resize(first_.back());
    // Each list's start moves to its end, which is the next one's start.
    for_blocks(threads, count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        visit(i, [&](int node, const Item& item) { items_[next(node)] = item; });
    });
    std::copy_backward(first_.begin(), first_.end() - 1, first_.end());
    first_.front() = 0;
    // Threads come in any order.
    for_blocks(threads, nodes, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        std::sort(items_.begin() + first_[n], items_.begin() + first_[n + 1]);
    });
  }

  /// Sorted.
  std::span<const Item> of(std::size_t node) const {
    return {items_.data() + first_[node], items_.data() + first_[node + 1]};
  }

 private:
  std::uint32_t next(int place) {
    return std::atomic_ref(first_[place]).fetch_add(1, std::memory_order_relaxed);
  }

  std::vector<std::uint32_t> first_;
  std::vector<Item> items_;
};

/// An edge by its higher node, with its mid node.
struct MidNode {
  int high = 0, mid = 0;
  auto operator<=>(const MidNode&) const = default;
};

/// The edge list of node `low`: one mid node for each edge, one edge for each mid node.
void check_mid_nodes_of(int low, std::span<const MidNode> edges, std::vector<char>& is_mid) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1]) continue;
    if (i > 0 && edges[i].high == edges[i - 1].high)
      fail("edge {}-{} has mid nodes {} and {}", low, edges[i].high, edges[i - 1].mid,
           edges[i].mid);
    if (std::atomic_ref(is_mid[edges[i].mid]).exchange(true, std::memory_order_relaxed))
      fail("mid node {} is on more than one edge", edges[i].mid);
  }
}

/// One mid node for each edge of an element, and one edge for each mid node.
void check_mid_nodes(const Mesh& m, int threads) {
  if (m.order == 1) return;
  const ListsByNode<MidNode> edges(
      threads, m.nodes.size(), m.tetrahedra.size(), [&](std::size_t i, const auto& add) {
        const auto& t = m.tetrahedra[i];
        for (int e = 0; e < 6; ++e) {
          const auto [low, high] =
              std::minmax(t[tetrahedron_edges[e][0]], t[tetrahedron_edges[e][1]]);
          add(low, MidNode{high, t[4 + e]});
        }
      });
  std::vector<char> is_mid(m.nodes.size(), false);
  for_blocks(threads, m.nodes.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      check_mid_nodes_of(static_cast<int>(n), edges.of(n), is_mid);
  });
  for (const auto& t : m.tetrahedra)
    for (int i = 0; i < 4; ++i)
      if (is_mid[t[i]]) fail("node {} is a corner and a mid node", t[i]);
  const auto expect = [&](int a, int b, int mid) {
    const auto [low, high] = std::minmax(a, b);
    const auto of_low = edges.of(static_cast<std::size_t>(low));
    if (!std::binary_search(of_low.begin(), of_low.end(), MidNode{high, mid}))
      fail("edge {}-{} with mid node {} of a triangle or line is in no tetrahedron", low, high,
           mid);
  };
  for_blocks(threads, m.triangles.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto& t = m.triangles[i];
      for (int e = 0; e < 3; ++e)
        expect(t[triangle_edges[e][0]], t[triangle_edges[e][1]], t[3 + e]);
    }
  });
  for (const auto& l : m.lines) expect(l[0], l[1], l[2]);
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

/// A triangle by its middle and highest corner, and its number: a facet's is 4 element + facet.
struct TriangleOfNode {
  int middle = 0, high = 0, number = 0;
  auto operator<=>(const TriangleOfNode&) const = default;
  bool same_corners(const TriangleOfNode& other) const {
    return middle == other.middle && high == other.high;
  }
};

/// Facets and triangles whose lowest corner is `low`.
void check_facets_of(const Mesh& m, int low, std::span<const TriangleOfNode> facets,
                     std::span<const TriangleOfNode> triangles) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < facets.size();) {
    std::array<Facet, 2> group;
    std::size_t end = i;
    for (; end < facets.size() && facets[end].same_corners(facets[i]); ++end) {
      if (end - i >= group.size()) continue;
      const int element = facets[end].number / 4;
      const auto& f = outward_facets[facets[end].number % 4];
      const auto& t = m.tetrahedra[element];
      group[end - i] = {
          {low, facets[i].middle, facets[i].high}, {t[f[0]], t[f[1]], t[f[2]]}, element};
    }
    int triangle = -1;
    if (next < triangles.size() && triangles[next].same_corners(facets[i]))
      triangle = triangles[next++].number;
    check_facet(m, group.data(), static_cast<int>(end - i), triangle);
    i = end;
  }
  if (next < triangles.size())
    fail("triangle {} is no facet of a tetrahedron, or is there twice", triangles[next].number);
}

void check_facets(const Mesh& m, int threads) {
  if (m.tetrahedra.size() > std::numeric_limits<int>::max() / 4)
    fail("{} tetrahedra are too many", m.tetrahedra.size());
  const auto add_sorted = [](const auto& add, const std::array<int, 3>& corners, int number) {
    const auto key = sorted(corners);
    add(key[0], TriangleOfNode{key[1], key[2], number});
  };
  using Lists = ListsByNode<TriangleOfNode>;
  const Lists facets(threads, m.nodes.size(), m.tetrahedra.size(),
                     [&](std::size_t e, const auto& add) {
                       const auto& t = m.tetrahedra[e];
                       for (int i = 0; i < 4; ++i) {
                         const auto& f = outward_facets[i];
                         add_sorted(add, {t[f[0]], t[f[1]], t[f[2]]}, 4 * static_cast<int>(e) + i);
                       }
                     });
  const Lists triangles(threads, m.nodes.size(), m.triangles.size(),
                        [&](std::size_t i, const auto& add) {
                          const auto& t = m.triangles[i];
                          add_sorted(add, {t[0], t[1], t[2]}, static_cast<int>(i));
                        });
  for_blocks(threads, m.nodes.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      check_facets_of(m, static_cast<int>(n), facets.of(n), triangles.of(n));
  });
}

/// Where entities tagged `tag` are, in a sorted list of tags.
std::pair<std::size_t, std::size_t> range_of(const std::vector<int>& tags, std::size_t tag) {
  const auto [first, last] = std::equal_range(tags.begin(), tags.end(), static_cast<int>(tag));
  return {static_cast<std::size_t>(first - tags.begin()),
          static_cast<std::size_t>(last - tags.begin())};
}

void check_lines_of_edge(const Mesh& m, std::size_t e) {
  const auto& vertices = m.topology.edges[e].vertices;
  int node = m.vertex_nodes[vertices[0]];
  const auto [first, last] = range_of(m.line_edge, e);
  for (std::size_t i = first; i < last; ++i) {
    if (m.lines[i][0] != node)
      fail("lines of edge {} do not follow each other at node {}", e, node);
    node = m.lines[i][1];
  }
  if (node != m.vertex_nodes[vertices[1]])
    fail("lines of edge {} end at node {}, not at its vertex", e, node);
}

void check_boundary_of_face(const Mesh& m, std::size_t f) {
  std::vector<std::array<int, 2>> directed, open, expected;
  const auto [first, last] = range_of(m.triangle_face, f);
  for (std::size_t i = first; i < last; ++i)
    for (const auto& e : triangle_edges)
      directed.push_back({m.triangles[i][e[0]], m.triangles[i][e[1]]});
  std::sort(directed.begin(), directed.end());
  for (const auto& [a, b] : directed)
    if (!std::binary_search(directed.begin(), directed.end(), std::array<int, 2>{b, a}))
      open.push_back({a, b});
  const auto& face = m.topology.faces[f];
  for (std::size_t k = 0; k < face.edges.size(); ++k) {
    const auto [from, to] = range_of(m.line_edge, static_cast<std::size_t>(face.edges[k]));
    for (std::size_t i = from; i < to; ++i) {
      const int a = m.lines[i][0], b = m.lines[i][1];
      expected.push_back(face.forward[k] ? std::array<int, 2>{a, b} : std::array<int, 2>{b, a});
    }
  }
  std::sort(expected.begin(), expected.end());
  if (open != expected) fail("the triangles of face {} are not bounded by its edges' lines", f);
  if (std::adjacent_find(directed.begin(), directed.end()) != directed.end())
    fail("two triangles of face {} overlap at an edge", f);
}

/// Lines run from vertex to vertex of their edge, and bound the triangles of their faces.
void check_lines(const Mesh& m, int threads) {
  core::parallel_for(threads, m.topology.edges.size(),
                     [&](std::size_t e) { check_lines_of_edge(m, e); });
  core::parallel_for(threads, m.topology.faces.size(),
                     [&](std::size_t f) { check_boundary_of_face(m, f); });
}

using Gradients = std::vector<std::array<Vec3, 10>>;

void check_jacobian(const Mesh& m, int e, const Gradients& gradients) {
  const auto& t = m.tetrahedra[e];
  core::Mat3 straight;
  for (int i = 0; i < 3; ++i) straight.col(i) = m.nodes[t[i + 1]] - m.nodes[t[0]];
  if (!(straight.determinant() > 0))
    fail("tetrahedron {} of grain {} is not positive: det {}", e, m.tetrahedron_cell[e],
         straight.determinant());
  // Below one with room for rounding: det J > 0 all over the element.
  if (m.order == 1 || curvature_bound(m, e) <= 0.5) return;
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = m.nodes[t[i]] - m.nodes[t[0]];
  for (std::size_t q = 0; q < gradients.size(); ++q) {
    const double det = tet10_jacobian(x, gradients[q]).determinant();
    if (!(det > 0))
      fail("tetrahedron {} of grain {} has det J = {} at point {} of the {}-point rule", e,
           m.tetrahedron_cell[e], det, q < 4 ? q : q - 4, q < 4 ? 4 : 15);
  }
}

/// Pairs hold; lines and triangles of slaves are those of their masters, in the same order,
/// triangles turned about.
void check_periodic(const Mesh& m) {
  std::vector<int> masters(m.nodes.size());
  std::vector<Shift> shifts(m.nodes.size(), Shift{});
  for (int i = 0; i < m.node_count(); ++i) masters[i] = i;
  int last = -1;
  for (const auto& p : m.periodic_nodes) {
    if (p.slave <= last || p.slave >= m.node_count() || p.master < 0 || p.master >= m.node_count())
      fail("periodic pair of nodes {} and {} of {}", p.slave, p.master, m.node_count());
    if (m.nodes[p.slave] != translated(m.nodes[p.master], p.shift, m.size))
      fail("node {} is no translate of node {}", p.slave, p.master);
    last = p.slave;
    masters[p.slave] = p.master;
    shifts[p.slave] = p.shift;
  }
  for (const auto& p : m.periodic_nodes)
    if (masters[p.master] != p.master) fail("node {} is a master and a slave", p.master);
  std::vector<int> first(m.topology.faces.size() + 1, 0);
  for (const int f : m.triangle_face) ++first[f + 1];
  for (std::size_t f = 0; f < m.topology.faces.size(); ++f) first[f + 1] += first[f];
  constexpr std::array<int, 6> turned{0, 2, 1, 5, 4, 3};
  for (const auto& p : m.topology.periodic.faces) {
    const int count = first[p.slave + 1] - first[p.slave];
    bool same = count == first[p.master + 1] - first[p.master];
    for (int t = 0; same && t < count; ++t)
      for (int i = 0; i < (m.order == 1 ? 3 : 6); ++i) {
        const int a = m.triangles[first[p.slave] + t][i];
        const int b = m.triangles[first[p.master] + t][turned[i]];
        same = same && masters[a] == masters[b] && shifts[a] - shifts[b] == p.shift;
      }
    if (!same) fail("the mesh of face {} is no translate of that of face {}", p.slave, p.master);
  }
}

void check_jacobians(const Mesh& m, int threads) {
  Gradients gradients;
  for (const auto& q : tet_quadrature_4()) gradients.push_back(tet10_gradients(q.xi));
  for (const auto& q : tet_quadrature_15()) gradients.push_back(tet10_gradients(q.xi));
  for_blocks(threads, m.tetrahedra.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e) check_jacobian(m, static_cast<int>(e), gradients);
  });
}

void check_all(const Mesh& mesh, int threads) {
  if (mesh.tetrahedra.empty()) fail("there are no tetrahedra");
  check_arrays(mesh);
  check_node_numbers(mesh);
  check_mid_nodes(mesh, threads);
  check_facets(mesh, threads);
  check_lines(mesh, threads);
  check_periodic(mesh);
  check_jacobians(mesh, threads);
}

}  // namespace

// Which of several faults threads find first may vary; one alone finds the same again.
void check(const Mesh& mesh, int threads) {
  try {
    check_all(mesh, threads);
  } catch (const InternalError&) {
    if (threads > 1) check_all(mesh, 1);
    throw;
  }
}

}  // namespace polyslip::mesh
