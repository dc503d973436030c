// Gmsh's format 2.2, ASCII.

#include <fmt/format.h>

#include <iterator>

#include "core/file.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

namespace {

/// Gmsh's element types: 4 and 11 tetrahedra of order 1 and 2, 2 and 9 triangles.
constexpr int tetrahedron_type(int order) { return order == 2 ? 11 : 4; }
constexpr int triangle_type(int order) { return order == 2 ? 9 : 2; }

void append_names(std::string& out, const Topology& topology) {
  fmt::format_to(std::back_inserter(out), "$PhysicalNames\n{}\n",
                 box_face_names.size() + topology.cell_faces.size());
  for (std::size_t i = 0; i < box_face_names.size(); ++i)
    fmt::format_to(std::back_inserter(out), "2 {} \"{}\"\n", i + 1, box_face_names[i]);
  for (int c = 0; c < topology.cell_count(); ++c)
    fmt::format_to(std::back_inserter(out), "3 {} \"grain{}\"\n", c + 1, c + 1);
  out += "$EndPhysicalNames\n";
}

template <std::size_t N>
void append_element(std::string& out, int id, int type, int physical, int elementary,
                    const std::array<int, N>& nodes) {
  fmt::format_to(std::back_inserter(out), "{} {} 2 {} {}", id, type, physical, elementary);
  for (int n : nodes)
    if (n >= 0) fmt::format_to(std::back_inserter(out), " {}", n + 1);
  out += '\n';
}

std::string msh_text(const Mesh& mesh) {
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  append_names(out, mesh.topology);
  fmt::format_to(std::back_inserter(out), "$Nodes\n{}\n", mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto& x = mesh.nodes[i];
    fmt::format_to(std::back_inserter(out), "{} {:.17g} {:.17g} {:.17g}\n", i + 1, x[0], x[1],
                   x[2]);
  }
  int domain_triangles = 0;
  for (int f : mesh.triangle_face) domain_triangles += mesh.topology.faces[f].domain_face >= 0;
  fmt::format_to(std::back_inserter(out), "$EndNodes\n$Elements\n{}\n",
                 mesh.tetrahedra.size() + domain_triangles);
  int id = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int grain = mesh.tetrahedron_cell[e] + 1;
    append_element(out, ++id, tetrahedron_type(mesh.order), grain, grain, mesh.tetrahedra[e]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int face = mesh.triangle_face[i], domain = mesh.topology.faces[face].domain_face;
    if (domain >= 0)
      append_element(out, ++id, triangle_type(mesh.order), domain + 1, face + 1, mesh.triangles[i]);
  }
  return out + "$EndElements\n";
}

}  // namespace

void write_msh(const Mesh& mesh, const std::string& path) {
  core::write_file(path, msh_text(mesh));
}

}  // namespace polyslip::mesh
