#include "mesh/grain_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "core/error.hpp"
#include "mesh/disc_parts.hpp"
#include "mesh/grain_surfaces.hpp"
#include "mesh/panel_shape.hpp"
#include "mesh/surface_panels.hpp"
#include "mesh/translated_nodes.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

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
  TopologyFinder(Mesh& mesh, const std::vector<int>& names)
      : mesh_(mesh), names_(names), translated_(mesh) {}

  void find() {
    take_panels();
    find_faces();
    pair_faces();
    find_segments();
    find_vertices();
    find_edges();
    find_loops();
    turn_slave_loops();
    require_grain_surfaces(mesh_, names_);
  }

 private:
  template <class... Args>
  [[noreturn]] static void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw core::InputError(fmt::format(text, std::forward<Args>(args)...));
  }

  /// "between grains 3 and 7", "of grain 3 on x0"
  std::string between(int face) const {
    const auto& f = mesh_.topology.faces[face];
    if (f.domain_face >= 0)
      return fmt::format("of grain {} on {}", names_[f.cells[0]],
                         mesh_.domain.faces[f.domain_face].name);
    if (f.cells[1] < 0)
      return fmt::format("of grain {} across the periodic boundary", names_[f.cells[0]]);
    return fmt::format("between grains {} and {}", names_[f.cells[0]], names_[f.cells[1]]);
  }

  std::string at(int node) const {
    const Vec3& x = mesh_.nodes[node];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  }

  void take_panels() {
    SurfacePanels found = find_panels(mesh_, names_, translated_);
    panels_ = std::move(found.panels);
    twins_ = found.twins;
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

  /// Panels joined by mesh edges that no third one meets make a face, or several discs.
  void find_faces() {
    sides_ = sorted_sides();
    parent_.resize(panels_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    std::vector<std::pair<int, int>> joints;
    for_each_mesh_edge(sides_, [&](const Side* first, std::size_t count) {
      if (!same_face_goes_on(first, count)) return;
      joints.push_back({first[0].panel, first[1].panel});
      const int a = root(first[0].panel), b = root(first[1].panel);
      parent_[std::max(a, b)] = std::min(a, b);
    });
    const std::vector<int> first_of = first_panels(std::move(joints));
    auto& t = mesh_.topology;
    face_of_.assign(panels_.size(), -1);
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      const int r = first_of[p];
      const Panel& panel = panels_[p];
      if (face_of_[r] < 0) {
        face_of_[r] = static_cast<int>(t.faces.size());
        TopologyFace face;
        face.cells = {panel.cell, std::max(panel.other, -1)};
        face.domain_face = panel.other < 0 && panel.twins < 0 ? -1 - panel.other : -1;
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

  /// The first panel of the disc that each panel is in.
  std::vector<int> first_panels(std::vector<std::pair<int, int>> joints) {
    TriangleSurface surface{{}, std::move(joints)};
    for (const Panel& p : panels_)
      surface.triangles.push_back({p.nodes[0], p.nodes[1], p.nodes[2]});
    const auto parts = disc_parts(surface, mesh_.nodes, [&](const auto& part) {
      return lies_flat(shape_of(mesh_, panels_, part));
    });
    std::vector<int> first, of_part;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const int panel = static_cast<int>(p);
      if (parts[p] == static_cast<int>(of_part.size())) of_part.push_back(panel);
      first.push_back(of_part[parts[p]]);
      if (panels_[p].twins >= 0 && first[p] != root(panel))
        fail(
            "the face of grain {} across the periodic boundary at {} is no disc that lies flat: it "
            "is "
            "not read",
            names_[panels_[p].cell], at(panels_[p].nodes[0]));
    }
    return first;
  }

  /// Pairs of faces, by their panels. Triangles of slaves are put in the order of their masters',
  /// each turned about from the same node.
  void pair_faces() {
    if (twins_ == 0) return;
    std::vector<std::array<int, 2>> pairs(twins_, {-1, -1});  // panels of each: master's, slave's
    for (std::size_t p = 0; p < panels_.size(); ++p)
      if (panels_[p].twins >= 0) {
        auto& [master, slave] = pairs[panels_[p].twins];
        (master < 0 ? master : slave) = static_cast<int>(p);
      }
    std::vector<std::array<int, 2>> by_faces;  // slave, pair
    for (int i = 0; i < twins_; ++i) {
      auto& [master, slave] = pairs[i];
      if (face_of_[slave] < face_of_[master]) std::swap(master, slave);
      by_faces.push_back({face_of_[slave], i});
    }
    std::sort(by_faces.begin(), by_faces.end());
    auto& list = mesh_.topology.periodic.faces;
    for (const auto& [face, i] : by_faces) {
      const auto [master, slave] = pairs[i];
      const PeriodicPair pair{face, face_of_[master], panels_[master].shift};
      if (list.empty() || list.back().slave != face) list.push_back(pair);
      if (list.back().master != pair.master || list.back().shift != pair.shift)
        fail("the periodic face {} has not one translate", between(face));
    }
    order_slave_triangles(pairs);
  }

  void order_slave_triangles(const std::vector<std::array<int, 2>>& pairs) {
    std::vector<int> next(mesh_.topology.faces.size(), 0);  // triangle of each face
    for (std::size_t t = mesh_.triangles.size(); t-- > 0;)
      next[mesh_.triangle_face[t]] = static_cast<int>(t);
    std::vector<int> slave_of(mesh_.topology.faces.size(), -1);
    for (const auto& pair : mesh_.topology.periodic.faces) slave_of[pair.master] = pair.slave;
    // Panels are sorted as their triangles are within a face.
    for (const Panel& panel : panels_) {
      if (panel.twins < 0 || &panel != &panels_[pairs[panel.twins][0]]) continue;
      const Panel& slave = panels_[pairs[panel.twins][1]];
      mesh_.triangles[next[face_of_[pairs[panel.twins][1]]]++] = turned_about(panel, slave);
    }
  }

  /// The nodes of a slave panel in the order in which the master's are, turned about.
  std::array<int, 6> turned_about(const Panel& master, const Panel& slave) const {
    constexpr std::array<int, 6> turned{0, 2, 1, 5, 4, 3};
    for (int first = 0; first < 3; ++first) {
      std::array<int, 6> nodes{};
      bool same = true;
      for (int i = 0; i < 6; ++i) {
        nodes[i] = slave.nodes[i < 3 ? (first + i) % 3 : 3 + (first + i) % 3];
        const int of_master = master.nodes[turned[i]];
        same =
            same && (nodes[i] < 0 || translated_.is_translate(nodes[i], of_master, master.shift));
      }
      if (same) return nodes;
    }
    fail("a periodic facet of grain {} at {} is no translate of its other side, node for node",
         names_[slave.cell], at(slave.nodes[0]));
  }

  void find_segments() {
    for_each_mesh_edge(sides_, [&](const Side* first, std::size_t count) {
      if (same_face_goes_on(first, count) && face_of_[first[0].panel] == face_of_[first[1].panel])
        return;
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

  /// Nodes on the way along segments from a node to the next vertex, both included, or once round.
  std::vector<int> chain(int node, int segment, const std::vector<char>& is_vertex,
                         std::vector<char>& seen) const {
    std::vector<int> nodes{node};
    for (;;) {
      const Segment& s = segments_[segment];
      seen[segment] = true;
      nodes.push_back(node = s.a == node ? s.b : s.a);
      if (node == nodes.front() || is_vertex[translated_.place(node).master]) return nodes;
      segment = next_segment(node, segment);
    }
  }

  /// Vertices on edges that would have none or the same at both ends, and on those that would have
  /// the same ends as another: new edges are straight, if coarse, and must not come together.
  void part_edges(std::vector<char>& is_vertex) const {
    const std::vector<char> given = is_vertex;
    std::vector<char> seen(segments_.size(), false);
    std::map<std::pair<int, int>, std::vector<std::vector<int>>> chains;  // by their ends
    const auto visit = [&](int node, int segment) {
      if (seen[segment]) return;
      auto nodes = chain(node, segment, given, seen);
      chains[std::minmax(nodes.front(), nodes.back())].push_back(std::move(nodes));
    };
    for (int n = 0; n < mesh_.node_count(); ++n)
      if (given[translated_.place(n).master])
        for (const int s : segments_at_[n]) visit(n, s);
    for (std::size_t s = 0; s < segments_.size(); ++s) visit(segments_[s].a, static_cast<int>(s));
    const auto mark = [&](int node) { is_vertex[translated_.place(node).master] = true; };
    for (const auto& [ends, same] : chains)
      for (const auto& nodes : same) {
        const std::size_t n = nodes.size() - 1;
        if (ends.first == ends.second)
          for (const std::size_t i : {std::size_t{0}, n / 3, 2 * n / 3}) mark(nodes[i]);
        else if (same.size() > 1 && n > 1)
          mark(nodes[n / 2]);
      }
  }

  void find_vertices() {
    vertex_at_.assign(mesh_.nodes.size(), -1);
    // One that a single grain sees as a node of an edge may be a vertex for others elsewhere.
    std::vector<char> is_vertex(mesh_.nodes.size(), false);
    for (int n = 0; n < mesh_.node_count(); ++n) {
      const auto& here = segments_at_[n];
      const bool inside = here.empty() || (here.size() == 2 &&
                                           segments_[here[0]].faces == segments_[here[1]].faces);
      if (!inside) is_vertex[translated_.place(n).master] = true;
    }
    part_edges(is_vertex);
    for (int n = 0; n < mesh_.node_count(); ++n) {
      const auto& [master, shift] = translated_.place(n);
      if (!is_vertex[master]) continue;
      vertex_at_[n] = mesh_.topology.vertex_count++;
      mesh_.vertex_nodes.push_back(n);
      if (master != n)
        mesh_.topology.periodic.vertices.push_back({vertex_at_[n], vertex_at_[master], shift});
    }
  }

  void find_edges() {
    for (const int n : mesh_.vertex_nodes)
      for (const int s : segments_at_[n])
        if (segments_[s].edge < 0) find_edge(n, s);
  }

  /// The edge that leaves a vertex along a segment; one that is the translate of another, and its
  /// lines, run as that one.
  void find_edge(int node, int segment) {
    const auto found = masters_.find(key_at(node, segment));
    if (found != masters_.end() && found->second.backwards)
      std::tie(node, segment) = other_end(node, segment);
    const int edge = static_cast<int>(mesh_.topology.edges.size());
    const int first_line = static_cast<int>(mesh_.lines.size());
    follow(node, segment);
    if (found != masters_.end()) {
      const auto& [master, start, backwards] = found->second;
      mesh_.topology.periodic.edges.push_back(
          {edge, master, translated_.place(node).shift - translated_.place(start).shift});
      return;
    }
    const auto &first = mesh_.lines[first_line], &last = mesh_.lines.back();
    masters_[translated_.directed(first[0], first[1])] = {edge, node, false};
    masters_.try_emplace(translated_.directed(last[1], last[0]), MasterEdge{edge, node, true});
  }

  std::tuple<int, int, Shift> key_at(int node, int segment) const {
    const Segment& s = segments_[segment];
    return translated_.directed(node, s.a == node ? s.b : s.a);
  }

  int next_segment(int node, int segment) const {
    const auto& here = segments_at_[node];
    return here[0] == segment ? here[1] : here[0];
  }

  /// Where the edge that leaves a vertex along a segment ends: vertex, and segment there.
  std::pair<int, int> other_end(int node, int segment) const {
    for (;;) {
      const Segment& s = segments_[segment];
      node = s.a == node ? s.b : s.a;
      if (vertex_at_[node] >= 0) return {node, segment};
      segment = next_segment(node, segment);
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
      segment = next_segment(node, segment);
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
    const std::string name = between(f);
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

  /// The loop of a slave begins where its master's does.
  void turn_slave_loops() {
    auto& t = mesh_.topology;
    const auto node = [&](int v) { return mesh_.vertex_nodes[v]; };
    for (const auto& pair : t.periodic.faces) {
      const int start = node(t.face_vertices(pair.master).front());
      const auto loop = t.face_vertices(pair.slave);
      const auto first = std::find_if(loop.begin(), loop.end(), [&](int v) {
        return translated_.is_translate(node(v), start, pair.shift);
      });
      if (first == loop.end())
        fail("the periodic face {} has other vertices than its translate", between(pair.slave));
      auto& face = t.faces[pair.slave];
      const auto by = first - loop.begin();
      std::rotate(face.edges.begin(), face.edges.begin() + by, face.edges.end());
      std::rotate(face.forward.begin(), face.forward.begin() + by, face.forward.end());
    }
  }

  /// An edge of which others are translates; or the same seen from its end.
  struct MasterEdge {
    int edge = -1, start = -1;
    bool backwards = false;
  };

  Mesh& mesh_;
  const std::vector<int>& names_;
  TranslatedNodes translated_;
  std::map<std::tuple<int, int, Shift>, MasterEdge> masters_;
  int twins_ = 0;  ///< pairs of periodic panels
  std::vector<Panel> panels_;
  std::vector<Side> sides_;
  std::vector<int> parent_, face_of_;  ///< of panels
  std::vector<Segment> segments_;
  std::vector<std::vector<int>> segments_at_;  ///< of nodes
  std::vector<int> vertex_at_;                 ///< of nodes; -1: none
};

}  // namespace

void find_grain_topology(Mesh& mesh, const std::vector<int>& grain_names) {
  TopologyFinder(mesh, grain_names).find();
}

}  // namespace polyslip::mesh
