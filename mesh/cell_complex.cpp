#include "mesh/cell_complex.hpp"

#include <algorithm>
#include <iterator>

#include "mesh/face_fan.hpp"
#include "mesh/folded_tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

void sort_unique(std::vector<int>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

std::vector<int> common(const std::vector<int>& p, const std::vector<int>& q) {
  std::vector<int> both;
  std::set_intersection(p.begin(), p.end(), q.begin(), q.end(), std::back_inserter(both));
  return both;
}

bool subset(const std::vector<int>& part, const std::vector<int>& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

}  // namespace

CellComplex::CellComplex(const Tessellation& tessellation) {
  FoldedTessellation folded = fold(tessellation);
  domain_ = std::move(folded.domain);
  periodic_ = domain_.is_periodic();
  seeds_ = std::move(folded.seeds);
  vertices_.resize(folded.vertices.size());
  edges_.resize(folded.edges.size());
  faces_.resize(folded.faces.size());
  cells_.resize(folded.cell_faces.size());
  for (std::size_t v = 0; v < vertices_.size(); ++v) vertices_[v].position = folded.vertices[v];
  for (int e = 0; e < edge_count(); ++e) {
    edges_[e].vertices = folded.edges[e].vertices;
    edges_[e].shift = folded.edges[e].shift;
    for (const int v : edges_[e].vertices) vertices_[v].edges.push_back(e);
  }
  for (int f = 0; f < face_count(); ++f) {
    const auto& from = folded.faces[f];
    Face& face = faces_[f];
    face.cells = from.cells;
    face.start = from.start;
    face.step = from.step;
    face.domain_face = from.domain_face;
    face.master = from.master;
    planes_.push_back(from.plane);
    for (std::size_t i = 0; i < from.edges.size(); ++i) {
      const int e = from.edges[i];
      face.loop.push_back({e, from.forward[i]});
      edges_[e].faces.push_back(f);
      if (face.domain_face >= 0)
        for (const int v : edges_[e].vertices) vertices_[v].walls.push_back(face.domain_face);
    }
    face.fault = fan_fault(loop_points(f), face.master);
  }
  for (Vertex& v : vertices_) sort_unique(v.walls);
  for (std::size_t c = 0; c < cells_.size(); ++c) cells_[c].faces = std::move(folded.cell_faces[c]);
}

double CellComplex::length(int edge) const {
  const auto [a, b] = edges_[edge].vertices;
  const Vec3 end = translated(vertices_[b].position, edges_[edge].shift, domain_.size);
  return (vertices_[a].position - end).norm();
}

std::vector<Plane> CellComplex::planes_at(int vertex) const {
  std::vector<Plane> planes;
  for (const int w : vertices_[vertex].walls) planes.push_back(domain_.faces[w].plane);
  return planes;
}

std::vector<int> CellComplex::loop_vertices(int face) const {
  std::vector<int> vertices;
  for (const Side& side : faces_[face].loop) vertices.push_back(start(side));
  return vertices;
}

std::vector<Vec3> CellComplex::loop_points(int face) const {
  std::vector<Vec3> points;
  points.reserve(faces_[face].loop.size());
  Shift shift = faces_[face].start;
  for (const Side& side : faces_[face].loop) {
    const Vec3& x = vertices_[start(side)].position;
    points.push_back(periodic_ ? translated(x, shift, domain_.size) : x);
    if (periodic_)
      shift = side.forward ? shift + edges_[side.edge].shift : shift - edges_[side.edge].shift;
  }
  return points;
}

Vec3 CellComplex::position_in(int face, int vertex) const {
  if (!periodic_) return vertices_[vertex].position;
  const auto vertices = loop_vertices(face);
  const auto at = std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin();
  return loop_points(face)[static_cast<std::size_t>(at)];
}

std::vector<int> CellComplex::faces_at(int vertex) const {
  std::vector<int> faces;
  for (const int e : vertices_[vertex].edges)
    faces.insert(faces.end(), edges_[e].faces.begin(), edges_[e].faces.end());
  sort_unique(faces);
  return faces;
}

std::vector<int> CellComplex::cells_at(int vertex) const {
  std::vector<int> cells;
  for (const int f : faces_at(vertex))
    cells.insert(cells.end(), faces_[f].cells.begin(), faces_[f].cells.end());
  sort_unique(cells);
  return cells;
}

int CellComplex::opposite(int edge, int vertex) const {
  const auto [a, b] = edges_[edge].vertices;
  return a == vertex ? b : a;
}

std::vector<int> CellComplex::triangles_of(int edge) const {
  std::vector<int> triangles;
  for (const int f : edges_[edge].faces)
    if (faces_[f].loop.size() == 3) triangles.push_back(f);
  return triangles;
}

bool CellComplex::keeps_four_faces(const std::vector<int>& lost) const {
  for (const int f : lost)
    for (const int c : faces_[f].cells) {
      if (c < 0) continue;
      std::size_t left = cells_[c].faces.size();
      for (const int g : lost) left -= faces_[g].cells[0] == c || faces_[g].cells[1] == c;
      if (left < 4) return false;
    }
  return true;
}

bool CellComplex::domain_allows(int edge) const {
  const auto [a, b] = edges_[edge].vertices;
  const auto &walls_a = vertices_[a].walls, &walls_b = vertices_[b].walls;
  if (!subset(walls_a, walls_b) && !subset(walls_b, walls_a)) return false;
  std::vector<int> walls_of_edge;
  for (const int f : edges_[edge].faces)
    if (faces_[f].domain_face >= 0) walls_of_edge.push_back(faces_[f].domain_face);
  sort_unique(walls_of_edge);
  return common(walls_a, walls_b) == walls_of_edge;
}

bool CellComplex::meets_itself(int edge) const {
  const auto [a, b] = edges_[edge].vertices;
  if (a == b) return true;
  for (const int v : {a, b})
    for (const int f : faces_at(v)) {
      if (faces_[f].cells[0] == faces_[f].cells[1]) return true;
      auto vertices = loop_vertices(f);
      std::sort(vertices.begin(), vertices.end());
      if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) return true;
    }
  return false;
}

void CellComplex::move_origin(int vertex, Shift shift) {
  if (is_zero(shift)) return;
  Vertex& v = change_vertex(vertex);
  v.position = translated(v.position, shift, domain_.size);
  const auto edges = v.edges;
  for (const int f : faces_at(vertex))
    if (start(faces_[f].loop.front()) == vertex) {
      Face& face = change_face(f);
      face.start = face.start - shift;
    }
  for (const int e : edges) {
    Edge& edge = change_edge(e);
    edge.shift = edge.vertices[0] == vertex ? edge.shift + shift : edge.shift - shift;
  }
}

CellComplex::Obstacle CellComplex::obstacle(int edge) const {
  if (periodic_ && meets_itself(edge)) return Obstacle::topology;
  if (!domain_allows(edge)) return Obstacle::domain;
  const auto [a, b] = edges_[edge].vertices;
  auto around = edges_[edge].faces;
  std::sort(around.begin(), around.end());
  if (common(faces_at(a), faces_at(b)) != around) return Obstacle::topology;

  std::vector<int> cells;
  for (const int f : around)
    cells.insert(cells.end(), faces_[f].cells.begin(), faces_[f].cells.end());
  sort_unique(cells);
  if (common(cells_at(a), cells_at(b)) != cells) return Obstacle::topology;

  const auto triangles = triangles_of(edge);
  std::vector<int> neighbours_a, neighbours_b;
  for (const int e : vertices_[a].edges)
    if (e != edge) neighbours_a.push_back(opposite(e, a));
  for (const int e : vertices_[b].edges)
    if (e != edge) neighbours_b.push_back(opposite(e, b));
  std::sort(neighbours_a.begin(), neighbours_a.end());
  std::sort(neighbours_b.begin(), neighbours_b.end());
  // No triangle may be missing, and no two may share their third vertex.
  if (common(neighbours_a, neighbours_b).size() != triangles.size()) return Obstacle::topology;
  return keeps_four_faces(triangles) ? Obstacle::none : Obstacle::topology;
}

void CellComplex::merge_sides_of_triangle(int face, int edge, int kept) {
  // The two other edges of the triangle; the one at the vertex that is kept stays.
  int stays = -1, goes = -1;
  for (const Side& side : faces_[face].loop) {
    if (side.edge == edge) continue;
    const auto& ends = edges_[side.edge].vertices;
    (ends[0] == kept || ends[1] == kept ? stays : goes) = side.edge;
  }
  const int removed = opposite(edge, kept), apex = opposite(stays, kept);
  for (const int f : edges_[goes].faces) {
    if (f == face) continue;
    for (Side& side : change_face(f).loop) {
      if (side.edge != goes) continue;
      const bool from_apex = start(side) == apex;
      side = {stays, (edges_[stays].vertices[0] == apex) == from_apex};
    }
    change_edge(stays).faces.push_back(f);
  }
  std::erase(change_edge(stays).faces, face);
  change_edge(goes).alive = false;
  std::erase(change_vertex(apex).edges, goes);
  std::erase(change_vertex(removed).edges, goes);
  change_face(face).alive = false;
  for (const int c : faces_[face].cells)
    if (c >= 0) std::erase(change_cell(c).faces, face);
}

int CellComplex::collapse(int edge) {
  const auto [a, b] = edges_[edge].vertices;
  move_origin(b, edges_[edge].shift);
  Vec3 position = 0.5 * (vertices_[a].position + vertices_[b].position);
  const auto &walls_a = vertices_[a].walls, &walls_b = vertices_[b].walls;
  const auto walls = walls_a.size() < walls_b.size() ? walls_b : walls_a;  // one holds the other

  const auto triangles = triangles_of(edge);
  for (const int f : edges_[edge].faces)
    if (faces_[f].loop.size() > 3)
      std::erase_if(change_face(f).loop, [&](const Side& side) { return side.edge == edge; });
  for (const int f : triangles) merge_sides_of_triangle(f, edge, a);

  Vertex& kept = change_vertex(a);
  kept.walls = walls;
  put_on_planes(planes_at(a), position);
  kept.position = position;
  std::erase(kept.edges, edge);
  for (const int e : vertices_[b].edges) {
    if (e == edge) continue;
    for (int& v : change_edge(e).vertices)
      if (v == b) v = a;
    kept.edges.push_back(e);
  }
  change_vertex(b).alive = false;
  change_edge(edge).alive = false;
  return a;
}

void CellComplex::move(int vertex, const Vec3& position) {
  change_vertex(vertex).position = position;
}

void CellComplex::set_fan(int face, int master, double fault) {
  Face& f = change_face(face);
  f.master = master;
  f.fault = fault;
}

CellComplex::Vertex& CellComplex::change_vertex(int id) {
  journal_.push_back({id, vertices_[id]});
  return vertices_[id];
}

CellComplex::Edge& CellComplex::change_edge(int id) {
  journal_.push_back({id, edges_[id]});
  return edges_[id];
}

CellComplex::Face& CellComplex::change_face(int id) {
  journal_.push_back({id, faces_[id]});
  return faces_[id];
}

CellComplex::Cell& CellComplex::change_cell(int id) {
  journal_.push_back({id, cells_[id]});
  return cells_[id];
}

void CellComplex::roll_back(std::size_t mark) {
  while (journal_.size() > mark) {
    auto& [id, content] = journal_.back();
    if (auto* vertex = std::get_if<Vertex>(&content)) vertices_[id] = std::move(*vertex);
    if (auto* edge = std::get_if<Edge>(&content)) edges_[id] = std::move(*edge);
    if (auto* face = std::get_if<Face>(&content)) faces_[id] = std::move(*face);
    if (auto* cell = std::get_if<Cell>(&content)) cells_[id] = std::move(*cell);
    journal_.pop_back();
  }
}

bool CellComplex::on_polyline(int vertex) const {
  // A face holds two edges of each of its vertices, so a cell has as many faces as edges there.
  std::vector<int> cells;
  for (const int f : faces_at(vertex))
    for (const int c : faces_[f].cells)
      if (c >= 0) cells.push_back(c);
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = 0; i < cells.size();) {
    std::size_t j = i;
    while (j < cells.size() && cells[j] == cells[i]) ++j;
    if (j - i < 3) return true;
    i = j;
  }
  return false;
}

bool CellComplex::polyline_since(std::size_t mark) const {
  return std::any_of(journal_.begin() + static_cast<long>(mark), journal_.end(),
                     [&](const Saved& saved) {
                       return std::holds_alternative<Vertex>(saved.content) &&
                              vertices_[saved.id].alive && on_polyline(saved.id);
                     });
}

void CellComplex::store(Tessellation& tessellation) const {
  const auto number = [](const auto& all) {
    std::vector<int> ids(all.size(), -1);
    int next = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].alive) ids[i] = next++;
    return ids;
  };
  const auto vertex_ids = number(vertices_), edge_ids = number(edges_), face_ids = number(faces_);

  FoldedTessellation folded;
  folded.domain = domain_;
  folded.seeds = seeds_;
  for (const Vertex& v : vertices_)
    if (v.alive) folded.vertices.push_back(v.position);
  for (const Edge& e : edges_)
    if (e.alive)
      folded.edges.push_back({{vertex_ids[e.vertices[0]], vertex_ids[e.vertices[1]]}, e.shift});
  for (int f = 0; f < face_count(); ++f) {
    const Face& face = faces_[f];
    if (!face.alive) continue;
    FoldedTessellation::Face out;
    out.cells = face.cells;
    out.start = face.start;
    out.step = face.step;
    out.domain_face = face.domain_face;
    out.plane = planes_[f];
    out.master = face.master;
    for (const Side& side : face.loop) {
      out.edges.push_back(edge_ids[side.edge]);
      out.forward.push_back(side.forward);
    }
    folded.faces.push_back(std::move(out));
  }
  for (const Cell& c : cells_) {
    folded.cell_faces.emplace_back();
    for (const int f : c.faces) folded.cell_faces.back().push_back(face_ids[f]);
  }
  tessellation = unfold(std::move(folded));
}

}  // namespace polyslip::mesh
