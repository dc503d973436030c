#include "mesh/folded_tessellation.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Numbers the translates of entities: the first that is met is the entity itself.
class Images {
 public:
  explicit Images(std::size_t count) : next_(static_cast<int>(count)), first_(count), met_(count) {}

  /// Number of the translate that is `shift` from where the entity is said to be.
  int of(int entity, const Shift& shift, std::vector<PeriodicPair>& pairs) {
    if (!met_[entity]) {
      met_[entity] = true;
      first_[entity] = shift;
    }
    if (first_[entity] == shift) return entity;
    const auto [at, added] = numbers_.try_emplace({entity, shift}, next_);
    if (added) pairs.push_back({next_++, entity, shift - first_[entity]});
    return at->second;
  }
  const Shift& first(int entity) const { return first_[entity]; }

 private:
  int next_;
  std::vector<Shift> first_;
  std::vector<char> met_;
  std::map<std::pair<int, Shift>, int> numbers_;
};

class Unfolding {
 public:
  explicit Unfolding(FoldedTessellation folded)
      : folded_(std::move(folded)),
        vertices_(folded_.vertices.size()),
        edges_(folded_.edges.size()) {}

  Tessellation run() {
    auto& t = result_.topology;
    for (std::size_t f = 0; f < folded_.faces.size(); ++f) add_face(folded_.faces[f]);
    t.cell_faces = folded_.cell_faces;
    for (std::size_t f = 0; f < folded_.faces.size(); ++f)
      if (is_outer(folded_.faces[f])) add_slave(static_cast<int>(f));
    place_vertices();
    list_edges();
    result_.domain = std::move(folded_.domain);
    result_.size = result_.domain.size;
    result_.seeds = std::move(folded_.seeds);
    result_.weights = std::move(folded_.weights);
    return std::move(result_);
  }

 private:
  using Face = FoldedTessellation::Face;

  static bool is_outer(const Face& f) {
    return f.cells[1] >= 0 && (f.cells[0] == f.cells[1] || !is_zero(f.step));
  }

  // Edges of the loop as it is where the first vertex is `start` from its position.
  std::vector<int> edges_along(const Face& f, Shift start) {
    auto& periodic = result_.topology.periodic;
    std::vector<int> edges;
    for (std::size_t i = 0; i < f.edges.size(); ++i) {
      const auto& e = folded_.edges[f.edges[i]];
      const Shift end = f.forward[i] ? start + e.shift : start - e.shift;
      vertices_.of(e.vertices[f.forward[i] ? 0 : 1], start, periodic.vertices);
      edges.push_back(edges_.of(f.edges[i], f.forward[i] ? start : end, periodic.edges));
      start = end;
    }
    return edges;
  }

  void add_face(const Face& f) {
    TopologyFace face;
    face.edges = edges_along(f, f.start);
    face.forward = f.forward;
    face.cells = {f.cells[0], is_outer(f) ? -1 : f.cells[1]};
    face.domain_face = f.domain_face;
    result_.topology.faces.push_back(std::move(face));
    result_.face_planes.push_back(f.plane);
    result_.face_masters.push_back(f.master);
  }

  void add_slave(int id) {
    const Face& f = folded_.faces[id];
    auto& t = result_.topology;
    const int slave = static_cast<int>(t.faces.size());
    TopologyFace face;
    face.edges = edges_along(f, f.start + f.step);
    face.forward = f.forward;
    std::reverse(face.edges.begin(), face.edges.end());
    face.forward.flip();
    std::reverse(face.forward.begin(), face.forward.end());
    face.cells = {f.cells[1], -1};
    t.faces.push_back(std::move(face));
    auto& list = t.cell_faces[f.cells[1]];
    if (f.cells[0] == f.cells[1])
      list.push_back(slave);
    else
      *std::find(list.begin(), list.end(), id) = slave;
    t.periodic.faces.push_back({slave, id, f.step});
    Plane plane{-f.plane.normal, 0};
    plane.offset = -f.plane.offset + plane.normal.dot(translated(Vec3::Zero(), f.step, size()));
    result_.face_planes.push_back(plane);
    const int n = static_cast<int>(f.edges.size());
    result_.face_masters.push_back(f.master < 0 ? -1 : (n - f.master) % n);
  }

  void place_vertices() {
    auto& x = result_.vertices;
    for (std::size_t v = 0; v < folded_.vertices.size(); ++v)
      x.push_back(translated(folded_.vertices[v], vertices_.first(static_cast<int>(v)), size()));
    for (const auto& pair : result_.topology.periodic.vertices)
      x.push_back(translated(x[pair.master], pair.shift, size()));
    result_.topology.vertex_count = static_cast<int>(x.size());
  }

  void list_edges() {
    auto& t = result_.topology;
    const auto ends_of = [&](int edge, const Shift& shift) {
      const auto& e = folded_.edges[edge];
      return TopologyEdge{{vertices_.of(e.vertices[0], shift, t.periodic.vertices),
                           vertices_.of(e.vertices[1], shift + e.shift, t.periodic.vertices)}};
    };
    for (int e = 0; e < static_cast<int>(folded_.edges.size()); ++e)
      t.edges.push_back(ends_of(e, edges_.first(e)));
    for (const auto& pair : t.periodic.edges)
      t.edges.push_back(ends_of(pair.master, edges_.first(pair.master) + pair.shift));
  }

  const Vec3& size() const { return size_; }

  FoldedTessellation folded_;
  Vec3 size_ = folded_.domain.size;
  Tessellation result_;
  Images vertices_, edges_;
};

/// Entity of each number, and where its master is from there.
struct Folding {
  std::vector<int> entity;
  std::vector<Shift> shift;

  Folding(const std::vector<PeriodicPair>& pairs, int count)
      : entity(count), shift(count, Shift{}) {
    const auto slaves = pair_of_slave(pairs, count);
    int next = 0;
    for (int i = 0; i < count; ++i)
      if (slaves[i] < 0) entity[i] = next++;
    for (const auto& pair : pairs) {
      entity[pair.slave] = entity[pair.master];
      shift[pair.slave] = pair.shift;
    }
  }
};

}  // namespace

Tessellation unfold(FoldedTessellation folded) { return Unfolding(std::move(folded)).run(); }

FoldedTessellation fold(const Tessellation& tessellation) {
  const Topology& t = tessellation.topology;
  const Folding vertices(t.periodic.vertices, t.vertex_count);
  const Folding edges(t.periodic.edges, static_cast<int>(t.edges.size()));
  const Folding faces(t.periodic.faces, static_cast<int>(t.faces.size()));
  const auto vertex_slaves = pair_of_slave(t.periodic.vertices, t.vertex_count);
  const auto edge_slaves = pair_of_slave(t.periodic.edges, static_cast<int>(t.edges.size()));
  const auto face_slaves = pair_of_slave(t.periodic.faces, static_cast<int>(t.faces.size()));

  FoldedTessellation result;
  result.domain = tessellation.domain;
  result.seeds = tessellation.seeds;
  result.weights = tessellation.weights;
  for (int v = 0; v < t.vertex_count; ++v)
    if (vertex_slaves[v] < 0) result.vertices.push_back(tessellation.vertices[v]);
  for (std::size_t e = 0; e < t.edges.size(); ++e) {
    if (edge_slaves[e] >= 0) continue;
    const auto [a, b] = t.edges[e].vertices;
    result.edges.push_back(
        {{vertices.entity[a], vertices.entity[b]}, vertices.shift[b] - vertices.shift[a]});
  }
  for (std::size_t i = 0; i < t.faces.size(); ++i) {
    if (face_slaves[i] >= 0) continue;
    const int f = static_cast<int>(i);
    FoldedTessellation::Face face;
    for (const int e : t.faces[f].edges) face.edges.push_back(edges.entity[e]);
    face.forward = t.faces[f].forward;
    face.cells = t.faces[f].cells;
    face.start = vertices.shift[t.face_vertices(f).front()];
    face.domain_face = t.faces[f].domain_face;
    face.plane = tessellation.face_planes[f];
    face.master = tessellation.face_masters[f];
    result.faces.push_back(std::move(face));
  }
  for (const auto& pair : t.periodic.faces) {
    auto& face = result.faces[faces.entity[pair.slave]];
    face.cells[1] = t.faces[pair.slave].cells[0];
    face.step = pair.shift;
  }
  for (const auto& cell : t.cell_faces) {
    result.cell_faces.emplace_back();
    auto& list = result.cell_faces.back();
    for (const int f : cell) {
      const int entity = faces.entity[f];
      if (face_slaves[f] < 0 || std::find(list.begin(), list.end(), entity) == list.end())
        list.push_back(entity);
    }
  }
  return result;
}

}  // namespace polyslip::mesh
