#include "remap/remesh.hpp"

#include <fmt/format.h>

#include "remap/audit.hpp"

namespace polyslip::remap {

mesh::Snapshot remesh(const mesh::Snapshot& old, const mesh::MeshingOptions& meshing,
                      const RemeshingOptions& options, mesh::MesherPool& pool, RemeshReport& report,
                      const std::function<void(const std::string&)>& log) {
  report = {};
  report.strain = old.strain;
  const mesh::Geometry geometry = mesh::geometry_of(old.mesh);
  mesh::Mesh mesh =
      mesh::mesh_geometry(geometry, meshing, core::Vec3::Ones(), pool, report.meshing);
  for (const std::string& fault : report.meshing.faults) log(fault);
  for (int face : report.meshing.copied_faces)
    log(fmt::format("face {}: not remeshed, its old mesh is kept", face + 1));
  mesh::check(mesh);
  mesh::Snapshot result = transport(old, std::move(mesh));
  audit(old, result, options, report);
  return result;
}

}  // namespace polyslip::remap
