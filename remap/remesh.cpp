#include "remap/remesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "remap/audit.hpp"

namespace polyslip::remap {

core::Vec3 meshing_scale(const mesh::Mesh& mesh, double orthotropic_share) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& x : mesh.nodes) box.extend(x);
  const core::Vec3 stretch = mesh.size.cwiseQuotient(box.sizes());
  core::Vec3 scale;
  for (int a = 0; a < 3; ++a) scale[a] = std::pow(std::max(1.0, stretch[a]), orthotropic_share);
  return scale;
}

mesh::Snapshot remesh(const mesh::Snapshot& old, const mesh::MeshingOptions& meshing,
                      const RemeshingOptions& options, mesh::MesherPool& pool, RemeshReport& report,
                      const std::function<void(const std::string&)>& log) {
  report = {};
  report.strain = old.strain;
  const mesh::Geometry geometry = mesh::geometry_of(old.mesh);
  mesh::Mesh mesh = mesh::mesh_geometry(
      geometry, meshing, meshing_scale(old.mesh, options.orthotropic_share), pool, report.meshing);
  for (const std::string& fault : report.meshing.faults) log(fault);
  for (int face : report.meshing.copied_faces)
    log(fmt::format("face {}: not remeshed, its old mesh is kept", face + 1));
  const std::string repairs = mesh::repairs_text(report.meshing);
  if (!repairs.empty()) log(fmt::format("remeshing at strain {:.6g}: {}", old.strain, repairs));
  mesh::check(mesh);
  const int threads = core::thread_count(meshing.jobs);
  mesh::Snapshot result = transport(old, std::move(mesh), options.transport, threads);
  report.beyond_limits = audit(old, result, options, report, threads);
  return result;
}

}  // namespace polyslip::remap
