#include "mesh/geometry.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "core/error.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// Six-node triangles made of corners, with one mid node an edge at its middle.
class FlatFace {
 public:
  explicit FlatFace(FaceShape& shape) : shape_(shape) {}

  void add(int a, int b, int c) {
    shape_.triangles.push_back({a, b, c, middle(a, b), middle(b, c), middle(c, a)});
  }

 private:
  int middle(int a, int b) {
    for (const auto& m : middles_)
      if ((m[0] == a && m[1] == b) || (m[0] == b && m[1] == a)) return m[2];
    shape_.points.push_back((shape_.points[a] + shape_.points[b]) / 2);
    middles_.push_back({a, b, static_cast<int>(shape_.points.size()) - 1});
    return middles_.back()[2];
  }

  FaceShape& shape_;
  std::vector<std::array<int, 3>> middles_;
};

/// Interpolation triangles of a face (section 2.1.2.2): a fan from its master point.
FaceShape interpolation_triangles(const Tessellation& tessellation, int face) {
  const auto vertices = tessellation.topology.face_vertices(face);
  const int n = static_cast<int>(vertices.size()), master = tessellation.face_masters[face];
  FaceShape shape;
  for (int v : vertices) shape.points.push_back(tessellation.vertices[v]);
  FlatFace flat(shape);
  if (master >= 0) {
    for (int i = 1; i + 1 < n; ++i) flat.add(master, (master + i) % n, (master + i + 1) % n);
    return shape;
  }
  Vec3 barycentre = Vec3::Zero();
  for (int i = 0; i < n; ++i) barycentre += shape.points[i];
  shape.points.push_back(barycentre / n);
  for (int i = 0; i < n; ++i) flat.add(n, i, (i + 1) % n);
  return shape;
}

}  // namespace

Geometry geometry_of(const Tessellation& tessellation) {
  Geometry g;
  g.topology = tessellation.topology;
  g.domain = tessellation.domain;
  g.size = tessellation.size;
  g.vertices = tessellation.vertices;
  for (const auto& edge : g.topology.edges) {
    const Vec3 &a = g.vertices[edge.vertices[0]], &b = g.vertices[edge.vertices[1]];
    g.edges.push_back({{a, (a + b) / 2, b}});
  }
  for (std::size_t f = 0; f < g.topology.faces.size(); ++f)
    g.faces.push_back(interpolation_triangles(tessellation, static_cast<int>(f)));
  return g;
}

Vec3 isotropic_scale(const Geometry& geometry) {
  if (!geometry.from_mesh) return Vec3::Ones();
  Eigen::AlignedBox3d box;
  for (const auto& face : geometry.faces)
    for (const Vec3& x : face.points) box.extend(x);
  return geometry.size.cwiseQuotient(box.sizes());
}

Vec3 isotropic_scale(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.nodes) box.extend(x);
  return mesh.size.cwiseQuotient(box.sizes());
}

Geometry geometry_of(const Mesh& mesh) {
  if (mesh.order != 2)
    throw core::InternalError(
        fmt::format("geometry of a mesh: order {}, but the shape needs mid nodes", mesh.order));
  Geometry g;
  g.from_mesh = true;
  g.topology = mesh.topology;
  g.domain = mesh.domain;
  g.size = mesh.size;
  for (int n : mesh.vertex_nodes) g.vertices.push_back(mesh.nodes[n]);
  g.edges.resize(g.topology.edges.size());
  for (std::size_t i = 0; i < mesh.lines.size(); ++i) {
    auto& points = g.edges[mesh.line_edge[i]].points;
    const auto& line = mesh.lines[i];
    if (points.empty()) points.push_back(mesh.nodes[line[0]]);
    points.push_back(mesh.nodes[line[2]]);
    points.push_back(mesh.nodes[line[1]]);
  }
  g.faces.resize(g.topology.faces.size());
  std::vector<int> local(mesh.nodes.size(), -1), owner(mesh.nodes.size(), -1);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int f = mesh.triangle_face[i];
    auto& shape = g.faces[f];
    std::array<int, 6> triangle{};
    for (int k = 0; k < 6; ++k) {
      const int node = mesh.triangles[i][k];
      if (owner[node] != f) {
        owner[node] = f;
        local[node] = static_cast<int>(shape.points.size());
        shape.points.push_back(mesh.nodes[node]);
      }
      triangle[k] = local[node];
    }
    shape.triangles.push_back(triangle);
  }
  return g;
}

}  // namespace polyslip::mesh
