#include "mesh/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "core/error.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// Mid nodes by the corner nodes of their edge.
class MidNodes {
 public:
  explicit MidNodes(Mesh& mesh) : mesh_(mesh) {}

  void add(int a, int b, const Vec3& x) {
    if (mesh_.order == 1) return;
    if (!ids_.emplace(key(a, b), mesh_.node_count()).second)
      throw core::InternalError(fmt::format(
          "mesh assembly: nodes {} and {} are joined by two edges of the surfaces", a + 1, b + 1));
    mesh_.nodes.push_back(x);
  }
  /// -1 in a mesh of order 1.
  int find(int a, int b) const {
    if (mesh_.order == 1) return -1;
    const auto it = ids_.find(key(a, b));
    if (it == ids_.end()) throw core::InternalError("mesh assembly: an edge has no mid node");
    return it->second;
  }
  /// Makes a straight one if there is none.
  int of(int a, int b) {
    if (mesh_.order == 1) return -1;
    const auto [it, added] = ids_.try_emplace(key(a, b), mesh_.node_count());
    if (added) mesh_.nodes.push_back((mesh_.nodes[a] + mesh_.nodes[b]) / 2);
    return it->second;
  }

 private:
  static std::uint64_t key(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
  }

  Mesh& mesh_;
  std::unordered_map<std::uint64_t, int> ids_;  // looked up only, never walked through
};

void add_lines(Mesh& mesh, MidNodes& mids, const BoundaryMesher& boundary,
               const BoundaryNumbers& numbers) {
  for (std::size_t e = 0; e < boundary.edges().size(); ++e) {
    const auto& edge = boundary.edges()[e];
    const int last = static_cast<int>(edge.nodes.size()) - 1;
    const auto node = [&](int i) {
      if (i == 0 || i == last) return mesh.topology.edges[e].vertices[i == 0 ? 0 : 1];
      return numbers.edge_first[e] + i - 1;
    };
    for (int i = 0; i < last; ++i) {
      mids.add(node(i), node(i + 1), edge.mids[i]);
      mesh.lines.push_back({node(i), node(i + 1), mids.find(node(i), node(i + 1))});
      mesh.line_edge.push_back(static_cast<int>(e));
    }
  }
}

void add_triangles(Mesh& mesh, MidNodes& mids, const BoundaryMesher& boundary,
                   const BoundaryNumbers& numbers) {
  for (std::size_t i = 0; i < boundary.faces().size(); ++i) {
    const int f = static_cast<int>(i);
    const auto& face = boundary.faces()[f];
    const auto nodes = boundary.face_nodes(f, numbers);
    for (const auto& e : face.inner_edges) mids.add(nodes[e.a], nodes[e.b], e.mid);
    for (const auto& t : face.triangles) {
      const int a = nodes[t[0]], b = nodes[t[1]], c = nodes[t[2]];
      mesh.triangles.push_back({a, b, c, mids.find(a, b), mids.find(b, c), mids.find(c, a)});
      mesh.triangle_face.push_back(f);
    }
  }
}

/// Grains' inner nodes and tetrahedra, corners only.
void add_grains(Mesh& mesh, const BoundaryMesher& boundary, const BoundaryNumbers& numbers,
                const std::vector<VolumeMesh>& volumes, const Vec3& scale) {
  const auto positions = mesh.nodes;
  for (int grain = 0; grain < mesh.topology.cell_count(); ++grain) {
    auto ids = grain_surface(mesh.topology, boundary, numbers, positions, grain, scale).numbers;
    const auto& volume = volumes[grain];
    for (std::size_t i = ids.size(); i < volume.nodes.size(); ++i) {
      ids.push_back(mesh.node_count());
      mesh.nodes.push_back(volume.nodes[i].cwiseQuotient(scale));
    }
    for (const auto& t : volume.tetrahedra) {
      std::array<int, 10> element;
      element.fill(-1);
      for (int i = 0; i < 4; ++i) element[i] = ids[t[i]];
      mesh.tetrahedra.push_back(element);
      mesh.tetrahedron_cell.push_back(grain);
    }
  }
}

}  // namespace

GrainSurface grain_surface(const Topology& topology, const BoundaryMesher& boundary,
                           const BoundaryNumbers& numbers, const std::vector<Vec3>& positions,
                           int grain, const Vec3& scale) {
  GrainSurface surface;
  std::unordered_map<int, int> local;  // looked up only
  for (int f : topology.cell_faces[grain]) {
    const bool outward = topology.faces[f].cells[0] == grain;
    const auto nodes = boundary.face_nodes(f, numbers);
    for (const auto& t : boundary.faces()[f].triangles) {
      std::array<int, 3> triangle{};
      for (int i = 0; i < 3; ++i) {
        const int number = nodes[t[i]];
        const auto [it, added] =
            local.try_emplace(number, static_cast<int>(surface.numbers.size()));
        if (added) {
          surface.numbers.push_back(number);
          surface.mesh.nodes.push_back(positions[number].cwiseProduct(scale));
        }
        triangle[i] = it->second;
      }
      if (!outward) std::swap(triangle[1], triangle[2]);
      surface.mesh.triangles.push_back(triangle);
      surface.faces.push_back(f);
    }
  }
  return surface;
}

Mesh assemble(const Geometry& geometry, const BoundaryMesher& boundary,
              const std::vector<VolumeMesh>& volumes, const Vec3& scale, int order) {
  Mesh mesh;
  mesh.order = order;
  mesh.topology = geometry.topology;
  mesh.domain = geometry.domain;
  mesh.size = geometry.size;
  const auto numbers = boundary.numbers();
  mesh.nodes = boundary.positions(numbers);
  for (int v = 0; v < mesh.topology.vertex_count; ++v) mesh.vertex_nodes.push_back(v);
  add_grains(mesh, boundary, numbers, volumes, scale);
  MidNodes mids(mesh);
  add_lines(mesh, mids, boundary, numbers);
  add_triangles(mesh, mids, boundary, numbers);
  for (auto& t : mesh.tetrahedra)
    for (int e = 0; e < 6; ++e)
      t[4 + e] = mids.of(t[tetrahedron_edges[e][0]], t[tetrahedron_edges[e][1]]);
  return mesh;
}

}  // namespace polyslip::mesh
