// Meshes of periodic edges and faces: a slave's is its master's, moved by whole periods.

#include <algorithm>
#include <numeric>

#include "mesh/boundary_mesh.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

std::vector<int> masters(const std::vector<PeriodicPair>& pairs, std::size_t count) {
  std::vector<int> of(count);
  std::iota(of.begin(), of.end(), 0);
  for (const auto& pair : pairs) of[pair.slave] = pair.master;
  return of;
}

template <class T>
void let_least_hold(const std::vector<PeriodicPair>& pairs, std::vector<T>& values) {
  for (const auto& pair : pairs)
    values[pair.master] = std::min(values[pair.master], values[pair.slave]);
  for (const auto& pair : pairs) values[pair.slave] = values[pair.master];
}

}  // namespace

void BoundaryMesher::join_translates() {
  const Topology& t = geometry_.topology;
  vertex_masters_ = masters(t.periodic.vertices, static_cast<std::size_t>(t.vertex_count));
  edge_masters_ = masters(t.periodic.edges, t.edges.size());
  face_masters_ = masters(t.periodic.faces, t.faces.size());
  let_least_hold(t.periodic.edges, edge_lengths_);
  let_least_hold(t.periodic.edges, sizes_.edges);
  let_least_hold(t.periodic.faces, sizes_.faces);
  for (const auto& pair : t.periodic.vertices)
    vertices_[pair.slave] = translated(vertices_[pair.master], pair.shift, geometry_.size);
}

void BoundaryMesher::copy_slave_edges() {
  for (const auto& pair : geometry_.topology.periodic.edges) {
    if (!edge_stale_[pair.master] && !edge_stale_[pair.slave]) continue;
    copy_slave_edge(pair);
    edge_stale_[pair.slave] = true;
  }
}

void BoundaryMesher::copy_slave_edge(const PeriodicPair& pair) {
  EdgeMesh& m = edges_[pair.slave] = edges_[pair.master];
  for (Vec3& x : m.nodes) x = translated(x, pair.shift, geometry_.size);
  for (Vec3& x : m.mids) x = translated(x, pair.shift, geometry_.size);
  const auto& ends = geometry_.topology.edges[pair.slave].vertices;
  m.nodes.front() = vertices_[ends[0]];
  m.nodes.back() = vertices_[ends[1]];
}

void BoundaryMesher::renew_slaves() {
  for (const auto& pair : geometry_.topology.periodic.edges) copy_slave_edge(pair);
  for (const auto& pair : geometry_.topology.periodic.faces) copy_slave_face(pair);
}

void BoundaryMesher::copy_slave_faces(std::vector<char>& changed) {
  for (const auto& pair : geometry_.topology.periodic.faces) {
    if (!face_stale_[pair.slave] && !changed[pair.master]) continue;
    copy_slave_face(pair);
    face_stale_[pair.slave] = false;
    changed[pair.slave] = true;
  }
}

// The loop of a slave runs backwards (Periodicity): local node k is the master's (n - k) mod n.
void BoundaryMesher::copy_slave_face(const PeriodicPair& pair) {
  FaceMesh m = faces_[pair.master];
  const int n = m.boundary_count;
  const auto local = [n](int k) { return k < n ? (n - k) % n : k; };
  for (Vec3& x : m.inner_nodes) x = translated(x, pair.shift, geometry_.size);
  for (auto& t : m.triangles) t = {local(t[0]), local(t[2]), local(t[1])};
  for (auto& e : m.inner_edges) {
    const auto [a, b] = std::minmax({local(e.a), local(e.b)});
    e = {a, b, translated(e.mid, pair.shift, geometry_.size)};
  }
  std::sort(m.inner_edges.begin(), m.inner_edges.end(),
            [](const FaceMesh::InnerEdge& p, const FaceMesh::InnerEdge& q) {
              return std::tie(p.a, p.b) < std::tie(q.a, q.b);
            });
  m.nearest_points = 0;
  faces_[pair.slave] = std::move(m);
}

bool BoundaryMesher::forbid(int face, std::array<int, 2> local) {
  if (is_slave_face(face)) {
    const int n = faces_[face].boundary_count;
    for (int& k : local) k = k < n ? (n - k) % n : k;
    std::sort(local.begin(), local.end());
    face = face_masters_[face];
  }
  auto& list = forbidden_[face];
  if (std::find(list.begin(), list.end(), local) != list.end()) return false;
  list.push_back(local);
  face_stale_[face] = true;
  return true;
}

}  // namespace polyslip::mesh
