#include "mesh/grain_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Facets of a positive tetrahedron, outward by the right-hand rule.
constexpr std::array<std::array<int, 3>, 4> outward_facets{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

/// Mid node of a tetrahedron between two of its corners.
int mid_between(const std::array<int, 10>& t, int i, int j) {
  for (int e = 0; e < 6; ++e) {
    const auto& ends = tetrahedron_edges[e];
    if ((ends[0] == i && ends[1] == j) || (ends[0] == j && ends[1] == i)) return t[4 + e];
  }
  throw core::InternalError("a tetrahedron has no edge between two of its corners");
}

struct Facet {
  std::array<int, 3> key;    ///< corners, sorted
  std::array<int, 6> nodes;  ///< outward
  int cell;
};

/// A facet of a face: nodes out of `cell`, into `other` (-1 - b: face b of the domain).
struct Panel {
  std::array<int, 6> nodes;
  int cell, other;
};

/// An edge of a panel.
struct Side {
  int low, high, mid, panel;
};

/// A mesh edge on an edge of the topology: from node a to b.
struct Segment {
  int a, b, mid;
  std::vector<int> faces;
  int edge = -1;
  bool forward = true;  ///< whether the edge runs from a to b
};

class TopologyFinder {
 public:
  TopologyFinder(Mesh& mesh, const std::vector<int>& names) : mesh_(mesh), names_(names) {}

  void find() {
    find_panels();
    put_on_domain();
    find_faces();
    find_segments();
    find_vertices();
    find_edges();
    find_loops();
    check_grains();
  }

 private:
  template <class... Args>
  [[noreturn]] static void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw core::InputError(fmt::format(text, std::forward<Args>(args)...));
  }

  /// "grain 3", "between grains 3 and 7", "of grain 3 on x0"
  std::string between(int cell, int other) const {
    if (other < 0)
      return fmt::format("of grain {} on {}", names_[cell], mesh_.domain.faces[-1 - other].name);
    return fmt::format("between grains {} and {}", names_[cell], names_[other]);
  }

  std::string at(int node) const {
    const Vec3& x = mesh_.nodes[node];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  }

  std::vector<Facet> sorted_facets() const {
    std::vector<Facet> facets;
    facets.reserve(4 * mesh_.tetrahedra.size());
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto& t = mesh_.tetrahedra[e];
      for (const auto& [i, j, k] : outward_facets) {
        Facet f{
            {t[i], t[j], t[k]},
            {t[i], t[j], t[k], mid_between(t, i, j), mid_between(t, j, k), mid_between(t, k, i)},
            mesh_.tetrahedron_cell[e]};
        std::sort(f.key.begin(), f.key.end());
        facets.push_back(f);
      }
    }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
      return std::tie(a.key, a.cell) < std::tie(b.key, b.cell);
    });
    return facets;
  }

  void find_panels() {
    const auto facets = sorted_facets();
    for (std::size_t i = 0; i < facets.size();) {
      std::size_t end = i;
      while (end < facets.size() && facets[end].key == facets[i].key) ++end;
      const Facet& f = facets[i];
      if (end - i > 2)
        fail("{} elements share a facet of grain {} at {}", end - i, names_[f.cell],
             at(f.nodes[0]));
      if (end - i == 1)
        panels_.push_back({f.nodes, f.cell, -1 - domain_face(f)});
      else if (facets[i + 1].cell != f.cell)
        panels_.push_back({f.nodes, f.cell, facets[i + 1].cell});
      i = end;
    }
    std::stable_sort(panels_.begin(), panels_.end(), [](const Panel& a, const Panel& b) {
      return std::tie(a.cell, a.other) < std::tie(b.cell, b.other);
    });
  }

  /// How far the nodes of a facet are from a face of the domain, at most.
  double distance(const Facet& f, const Plane& plane) const {
    double most = 0;
    for (const int n : f.nodes)
      if (n >= 0) most = std::max(most, std::abs(plane.normal.dot(mesh_.nodes[n]) - plane.offset));
    return most;
  }

  /// The face of the domain that a facet without a neighbour lies on; its nodes are noted to lie
  /// there.
  int domain_face(const Facet& f) {
    const auto& faces = mesh_.domain.faces;
    int best = 0;
    for (int d = 1; d < static_cast<int>(faces.size()); ++d)
      if (distance(f, faces[d].plane) < distance(f, faces[best].plane)) best = d;
    if (!(distance(f, faces[best].plane) <= 1e-6 * mesh_.size.minCoeff()))
      fail(
          "grain {} has a free facet at {} that lies on no side of the bounding box: the mesh has "
          "a "
          "hole or a crack, or its domain is neither a box along the axes nor another convex body",
          names_[f.cell], at(f.nodes[0]));
    for (const int n : f.nodes)
      if (n >= 0) on_domain_.push_back({n, best});
    return best;
  }

  void put_on_domain() {
    const DomainFaceLists lists(mesh_.nodes.size(), std::move(on_domain_));
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (lists[n].empty()) continue;
      std::vector<Plane> planes;
      for (const int d : lists[n]) planes.push_back(mesh_.domain.faces[d].plane);
      put_on_planes(planes, mesh_.nodes[n]);
      mesh_.nodes[n] = mesh_.nodes[n].cwiseMax(0.0).cwiseMin(mesh_.size);
    }
  }

  /// Sides of all panels, those of the same mesh edge next to each other.
  std::vector<Side> sorted_sides() const {
    std::vector<Side> sides;
    for (std::size_t p = 0; p < panels_.size(); ++p)
      for (int i = 0; i < 3; ++i) {
        const auto& n = panels_[p].nodes;
        const auto [low, high] = std::minmax(n[i], n[(i + 1) % 3]);
        sides.push_back({low, high, n[3 + i], static_cast<int>(p)});
      }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.panel) < std::tie(b.low, b.high, b.panel);
    });
    return sides;
  }

  bool same_face_goes_on(const Side* first, std::size_t count) const {
    if (count != 2) return false;
    const Panel &p = panels_[first[0].panel], &q = panels_[first[1].panel];
    return p.cell == q.cell && p.other == q.other;
  }

  template <class Visit>
  static void for_each_mesh_edge(const std::vector<Side>& sides, Visit&& visit) {
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i;
      while (end < sides.size() && sides[end].low == sides[i].low &&
             sides[end].high == sides[i].high)
        ++end;
      visit(&sides[i], end - i);
      i = end;
    }
  }

  int root(int panel) {
    while (parent_[panel] != panel) panel = parent_[panel] = parent_[parent_[panel]];
    return panel;
  }

  /// Panels joined by mesh edges that no third one meets make a face.
  void find_faces() {
    sides_ = sorted_sides();
    parent_.resize(panels_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    for_each_mesh_edge(sides_, [&](const Side* first, std::size_t count) {
      if (!same_face_goes_on(first, count)) return;
      const int a = root(first[0].panel), b = root(first[1].panel);
      parent_[std::max(a, b)] = std::min(a, b);
    });
    auto& t = mesh_.topology;
    face_of_.assign(panels_.size(), -1);
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      const int r = root(static_cast<int>(p));
      const Panel& panel = panels_[p];
      if (face_of_[r] < 0) {
        face_of_[r] = static_cast<int>(t.faces.size());
        TopologyFace face;
        face.cells = {panel.cell, std::max(panel.other, -1)};
        face.domain_face = panel.other < 0 ? -1 - panel.other : -1;
        t.cell_faces[panel.cell].push_back(face_of_[r]);
        if (panel.other >= 0) t.cell_faces[panel.other].push_back(face_of_[r]);
        t.faces.push_back(face);
      }
      face_of_[p] = face_of_[r];
    }
    std::vector<int> order(panels_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return face_of_[a] < face_of_[b]; });
    for (const int p : order) {
      mesh_.triangles.push_back(panels_[p].nodes);
      mesh_.triangle_face.push_back(face_of_[p]);
    }
  }

  void find_segments() {
    for_each_mesh_edge(sides_, [&](const Side* first, std::size_t count) {
      if (same_face_goes_on(first, count)) return;
      Segment s{first->low, first->high, first->mid, {}};
      for (std::size_t i = 0; i < count; ++i) s.faces.push_back(face_of_[first[i].panel]);
      std::sort(s.faces.begin(), s.faces.end());
      segments_.push_back(std::move(s));
    });
    segments_at_.resize(mesh_.nodes.size());
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      segments_at_[segments_[i].a].push_back(static_cast<int>(i));
      segments_at_[segments_[i].b].push_back(static_cast<int>(i));
    }
  }

  void find_vertices() {
    vertex_at_.assign(mesh_.nodes.size(), -1);
    for (int n = 0; n < mesh_.node_count(); ++n) {
      const auto& here = segments_at_[n];
      const bool inside = here.empty() || (here.size() == 2 &&
                                           segments_[here[0]].faces == segments_[here[1]].faces);
      if (inside) continue;
      vertex_at_[n] = mesh_.topology.vertex_count++;
      mesh_.vertex_nodes.push_back(n);
    }
  }

  void find_edges() {
    for (const int n : mesh_.vertex_nodes)
      for (const int s : segments_at_[n])
        if (segments_[s].edge < 0) follow(n, s);
    for (const Segment& s : segments_)
      if (s.edge < 0) {
        const auto& face = mesh_.topology.faces[s.faces[0]];
        fail("the edge of the face {} at {} is closed and has no vertex; such grains are not read",
             between(face.cells[0], face.domain_face >= 0 ? -1 - face.domain_face : face.cells[1]),
             at(s.a));
      }
  }

  /// The edge that leaves a vertex along a segment, to the next vertex.
  void follow(int node, int segment) {
    auto& t = mesh_.topology;
    const int edge = static_cast<int>(t.edges.size());
    const int from = vertex_at_[node];
    for (;;) {
      Segment& s = segments_[segment];
      s.edge = edge;
      s.forward = s.a == node;
      const int next = s.forward ? s.b : s.a;
      mesh_.lines.push_back({node, next, s.mid});
      mesh_.line_edge.push_back(edge);
      node = next;
      if (vertex_at_[node] >= 0) break;
      const auto& here = segments_at_[node];
      segment = here[0] == segment ? here[1] : here[0];
    }
    if (vertex_at_[node] == from) {
      const auto& face = t.faces[segments_[segment].faces[0]];
      fail("an edge of grain {} runs from the vertex at {} back to it; such grains are not read",
           names_[face.cells[0]], at(node));
    }
    t.edges.push_back({{from, vertex_at_[node]}});
  }

  struct Use {
    int edge;
    bool forward;
  };

  /// For each face, its edges and whether its triangles run along them.
  std::vector<std::vector<Use>> uses_of_edges() const {
    std::vector<std::vector<Use>> uses(mesh_.topology.faces.size());
    for (const Segment& s : segments_) {
      const int first_node = s.forward ? s.a : s.b;
      // One segment stands for its edge: that at the edge's first vertex.
      if (vertex_at_[first_node] != mesh_.topology.edges[s.edge].vertices[0]) continue;
      const auto range = std::equal_range(
          sides_.begin(), sides_.end(), Side{s.a, s.b, -1, -1}, [](const Side& p, const Side& q) {
            return std::tie(p.low, p.high) < std::tie(q.low, q.high);
          });
      for (auto side = range.first; side != range.second; ++side) {
        const auto& n = panels_[side->panel].nodes;
        bool along = false;
        for (int i = 0; i < 3; ++i) along |= n[i] == s.a && n[(i + 1) % 3] == s.b;
        uses[face_of_[side->panel]].push_back({s.edge, along == s.forward});
      }
    }
    return uses;
  }

  void find_loops() {
    const auto uses = uses_of_edges();
    for (std::size_t f = 0; f < uses.size(); ++f) find_loop(static_cast<int>(f), uses[f]);
  }

  void find_loop(int f, std::vector<Use> uses) {
    auto& t = mesh_.topology;
    auto& face = t.faces[f];
    const std::string name =
        between(face.cells[0], face.domain_face >= 0 ? -1 - face.domain_face : face.cells[1]);
    if (uses.empty()) fail("the face {} is closed: a grain inside another is not read", name);
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.edge < b.edge; });
    const auto start = [&](const Use& u) { return t.edges[u.edge].vertices[u.forward ? 0 : 1]; };
    const auto end = [&](const Use& u) { return t.edges[u.edge].vertices[u.forward ? 1 : 0]; };
    std::vector<int> starts;
    for (const Use& u : uses) starts.push_back(start(u));
    std::sort(starts.begin(), starts.end());
    const auto twice = std::adjacent_find(starts.begin(), starts.end());
    if (twice != starts.end())
      fail("the face {} touches itself at {}; such pinched faces are not read", name,
           at(mesh_.vertex_nodes[*twice]));
    std::size_t now = 0;
    do {
      face.edges.push_back(uses[now].edge);
      face.forward.push_back(uses[now].forward);
      const int vertex = end(uses[now]);
      now = 0;
      while (now < uses.size() && start(uses[now]) != vertex) ++now;
      if (now == uses.size())
        fail("the boundary of the face {} is open at {}", name, at(mesh_.vertex_nodes[vertex]));
    } while (now != 0 && face.edges.size() < uses.size());
    if (now != 0 || face.edges.size() != uses.size())
      fail("the face {} has a hole or is pinched: its boundary is more than one loop", name);
  }

  /// Each edge of a grain lies in two of its faces, and its surface is a sphere.
  void check_grains() const {
    const auto& t = mesh_.topology;
    for (int c = 0; c < t.cell_count(); ++c) {
      std::vector<int> edges, vertices;
      for (const int f : t.cell_faces[c]) {
        edges.insert(edges.end(), t.faces[f].edges.begin(), t.faces[f].edges.end());
        const auto loop = t.face_vertices(f);
        vertices.insert(vertices.end(), loop.begin(), loop.end());
      }
      std::sort(edges.begin(), edges.end());
      for (std::size_t i = 0; i < edges.size(); i += 2)
        if (i + 1 >= edges.size() || edges[i] != edges[i + 1] ||
            (i + 2 < edges.size() && edges[i] == edges[i + 2]))
          fail(
              "grain {} is pinched: its faces do not meet two by two at the edge that starts at {}",
              names_[c], at(mesh_.vertex_nodes[t.edges[edges[i]].vertices[0]]));
      std::sort(vertices.begin(), vertices.end());
      const auto v = std::unique(vertices.begin(), vertices.end()) - vertices.begin();
      const auto euler =
          v - static_cast<long>(edges.size() / 2) + static_cast<long>(t.cell_faces[c].size());
      if (euler != 2)
        fail(
            "grain {} is not one ball (V - E + F = {} for its surface, not 2): it is in parts, has "
            "a tunnel, or touches itself at a point",
            names_[c], euler);
    }
  }

  Mesh& mesh_;
  const std::vector<int>& names_;
  std::vector<Panel> panels_;
  std::vector<Side> sides_;
  std::vector<int> parent_, face_of_;  ///< of panels
  std::vector<Segment> segments_;
  std::vector<std::vector<int>> segments_at_;  ///< of nodes
  std::vector<int> vertex_at_;                 ///< of nodes; -1: none
  std::vector<std::array<int, 2>> on_domain_;  ///< nodes and the faces they lie on
};

}  // namespace

void find_grain_topology(Mesh& mesh, const std::vector<int>& grain_names) {
  TopologyFinder(mesh, grain_names).find();
}

}  // namespace polyslip::mesh
