// Gmsh's format 2.2, ASCII.

#include <fmt/format.h>

#include "core/file.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

namespace {

/// Gmsh's element types: 4 and 11 tetrahedra of order 1 and 2, 2 and 9 triangles.
constexpr int tetrahedron_type(int order) { return order == 2 ? 11 : 4; }
constexpr int triangle_type(int order) { return order == 2 ? 9 : 2; }

void put_names(core::FileWriter& out, const Topology& topology) {
  out.put(fmt::format("$PhysicalNames\n{}\n", box_face_names.size() + topology.cell_faces.size()));
  for (std::size_t i = 0; i < box_face_names.size(); ++i)
    out.put(fmt::format("2 {} \"{}\"\n", i + 1, box_face_names[i]));
  for (int c = 0; c < topology.cell_count(); ++c)
    out.put(fmt::format("3 {} \"grain{}\"\n", c + 1, c + 1));
  out.put("$EndPhysicalNames\n");
}

void put_nodes(core::FileWriter& out, const std::vector<core::Vec3>& nodes) {
  out.put(fmt::format("$Nodes\n{}\n", nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    out.put(i + 1);
    for (int axis = 0; axis < 3; ++axis) {
      out.put(' ');
      out.put(nodes[i][axis]);
    }
    out.put('\n');
  }
  out.put("$EndNodes\n");
}

template <std::size_t N>
void put_element(core::FileWriter& out, int id, int type, int physical, int elementary,
                 const std::array<int, N>& nodes) {
  out.put(id);
  out.put(' ');
  out.put(type);
  out.put(" 2 ");
  out.put(physical);
  out.put(' ');
  out.put(elementary);
  for (int n : nodes)
    if (n >= 0) {
      out.put(' ');
      out.put(n + 1);
    }
  out.put('\n');
}

void put_elements(core::FileWriter& out, const Mesh& mesh) {
  const auto domain_of = [&](std::size_t triangle) {
    return mesh.topology.faces[mesh.triangle_face[triangle]].domain_face;
  };
  std::size_t count = mesh.tetrahedra.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) count += domain_of(i) >= 0;
  out.put(fmt::format("$Elements\n{}\n", count));
  int id = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int grain = mesh.tetrahedron_cell[e] + 1;
    put_element(out, ++id, tetrahedron_type(mesh.order), grain, grain, mesh.tetrahedra[e]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (const int domain = domain_of(i); domain >= 0)
      put_element(out, ++id, triangle_type(mesh.order), domain + 1, mesh.triangle_face[i] + 1,
                  mesh.triangles[i]);
  out.put("$EndElements\n");
}

}  // namespace

void write_msh(const Mesh& mesh, const std::string& path) {
  core::FileWriter out(path);
  out.put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  put_names(out, mesh.topology);
  put_nodes(out, mesh.nodes);
  put_elements(out, mesh);
  out.finish();
}

}  // namespace polyslip::mesh
