#include "mesh/grain_surfaces.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "mesh/cell_surface.hpp"

namespace polyslip::mesh {
namespace {

std::string at_vertex(const Mesh& mesh, int vertex) {
  const core::Vec3& x = mesh.nodes[mesh.vertex_nodes[vertex]];
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::string describe(const Mesh& mesh, const SurfaceFault& fault) {
  switch (fault.kind) {
    case SurfaceFault::Kind::none:
      return "is fine";
    case SurfaceFault::Kind::edge_not_shared:
    case SurfaceFault::Kind::turned_about:
      return "is pinched: its faces do not meet two by two at the edge that starts at " +
             at_vertex(mesh, mesh.topology.edges[fault.where].vertices[0]);
    case SurfaceFault::Kind::parts:
      return fmt::format("has a surface in {} parts: it is in parts or has another grain inside",
                         fault.where);
    case SurfaceFault::Kind::touching:
      return "touches itself at the point " + at_vertex(mesh, fault.where);
  }
  return "";
}

}  // namespace

void require_grain_surfaces(const Mesh& mesh, const std::vector<int>& names) {
  for (int c = 0; c < mesh.topology.cell_count(); ++c) {
    const SurfaceFault fault = surface_fault(mesh.topology, c);
    if (fault.kind != SurfaceFault::Kind::none)
      throw core::InputError(fmt::format("grain {} {}", names[c], describe(mesh, fault)));
  }
}

}  // namespace polyslip::mesh
