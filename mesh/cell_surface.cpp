#include "mesh/cell_surface.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace polyslip::mesh {
namespace {

/// Sets that are joined pair by pair.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n), count_(static_cast<int>(n)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  int count() const { return count_; }

 private:
  std::vector<int> parent_;
  int count_;
};

/// A face of the cell at an edge, the face's number within the cell.
struct Side {
  int edge, face;
  bool forward;
};

std::vector<Side> sides_of(const Topology& t, int cell) {
  std::vector<Side> sides;
  const auto& faces = t.cell_faces[cell];
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const auto& face = t.faces[faces[k]];
    const bool outwards = face.cells[0] == cell;
    for (std::size_t i = 0; i < face.edges.size(); ++i)
      sides.push_back({face.edges[i], static_cast<int>(k), face.forward[i] == outwards});
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& p, const Side& q) { return p.edge < q.edge; });
  return sides;
}

/// The first vertex at which the faces of the cell are more than one fan; -1: none.
int touching_vertex(const Topology& t, int cell, const std::vector<Side>& sides) {
  std::vector<std::pair<int, int>> ends;  // vertex, edge
  for (std::size_t i = 0; i < sides.size(); i += 2)
    for (const int v : t.edges[sides[i].edge].vertices) ends.push_back({v, sides[i].edge});
  std::sort(ends.begin(), ends.end());
  const auto place = [&](int vertex, int edge) {
    return static_cast<int>(std::lower_bound(ends.begin(), ends.end(), std::pair{vertex, edge}) -
                            ends.begin());
  };
  Sets fans(ends.size());
  for (const int f : t.cell_faces[cell]) {
    const auto& edges = t.faces[f].edges;
    const auto vertices = t.face_vertices(f);
    for (std::size_t i = 0; i < edges.size(); ++i)
      fans.join(place(vertices[i], edges[i]),
                place(vertices[i], edges[(i + edges.size() - 1) % edges.size()]));
  }
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const int a = static_cast<int>(i - 1), b = static_cast<int>(i);
    if (ends[i].first == ends[i - 1].first && fans.root(a) != fans.root(b)) return ends[i].first;
  }
  return -1;
}

}  // namespace

SurfaceFault surface_fault(const Topology& t, int cell) {
  using Kind = SurfaceFault::Kind;
  const auto sides = sides_of(t, cell);
  Sets parts(t.cell_faces[cell].size());
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    const bool pair = i + 1 < sides.size() && sides[i].edge == sides[i + 1].edge;
    const bool triple = i + 2 < sides.size() && sides[i].edge == sides[i + 2].edge;
    if (!pair || triple) return {Kind::edge_not_shared, sides[i].edge};
    if (sides[i].forward == sides[i + 1].forward) return {Kind::turned_about, sides[i].edge};
    parts.join(sides[i].face, sides[i + 1].face);
  }
  if (parts.count() != 1) return {Kind::parts, parts.count()};
  const int vertex = touching_vertex(t, cell, sides);
  if (vertex >= 0) return {Kind::touching, vertex};
  return {};
}

}  // namespace polyslip::mesh
