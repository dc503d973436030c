#include "mesh/tessellation_of_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "mesh/face_fan.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

void check_edges(const Mesh& mesh, const std::string& path) {
  const double near = 1e-6 * mesh.size.minCoeff();
  for (std::size_t i = 0; i < mesh.lines.size(); ++i) {
    const auto [a, b] = mesh.topology.edges[mesh.line_edge[i]].vertices;
    const Vec3& from = mesh.nodes[mesh.vertex_nodes[a]];
    const Vec3 along = (mesh.nodes[mesh.vertex_nodes[b]] - from).normalized();
    for (const int n : mesh.lines[i]) {
      if (n < 0) continue;
      const Vec3 x = mesh.nodes[n] - from;
      if ((x - x.dot(along) * along).norm() <= near) continue;
      throw core::InputError(
          fmt::format("{}: the edge of grains from ({:.6g}, {:.6g}, {:.6g}) is not straight, so "
                      "the mesh is one of no tessellation; its topology is found when it is read",
                      path, from.x(), from.y(), from.z()));
    }
  }
}

/// Centroids of the grains, of straight elements.
std::vector<Vec3> centroids(const Mesh& mesh) {
  std::vector<Vec3> sums(mesh.topology.cell_faces.size(), Vec3::Zero());
  std::vector<double> volumes(sums.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& t = mesh.tetrahedra[e];
    const Vec3 &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]], &c = mesh.nodes[t[2]],
               &d = mesh.nodes[t[3]];
    const double volume = (b - a).cross(c - a).dot(d - a);
    sums[mesh.tetrahedron_cell[e]] += volume * (a + b + c + d) / 4;
    volumes[mesh.tetrahedron_cell[e]] += volume;
  }
  for (std::size_t c = 0; c < sums.size(); ++c) sums[c] /= volumes[c];
  return sums;
}

}  // namespace

Tessellation tessellation_of(const Mesh& mesh, const std::string& path) {
  check_edges(mesh, path);
  Tessellation t;
  t.topology = mesh.topology;
  t.domain = mesh.domain;
  t.size = mesh.size;
  t.seeds = centroids(mesh);
  for (const int n : mesh.vertex_nodes) t.vertices.push_back(mesh.nodes[n]);
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) {
    std::vector<Vec3> loop;
    for (const int v : t.topology.face_vertices(f)) loop.push_back(t.vertices[v]);
    Plane plane;
    plane.normal = vector_area(loop).normalized();
    plane.offset = plane.normal.dot(fan_master(loop, -1));
    t.face_planes.push_back(plane);
    t.face_masters.push_back(best_fan(loop).master);
  }
  try {
    t.check();
  } catch (const core::InternalError& e) {
    throw core::InputError(fmt::format(
        "{}: the mesh is one of no tessellation: {} (ids here from 0)", path, e.what()));
  }
  return t;
}

}  // namespace polyslip::mesh
