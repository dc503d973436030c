#include "remap/remesh.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/parallel.hpp"
#include "remap/audit.hpp"

namespace polyslip::remap {
namespace {

using Log = std::function<void(const std::string&)>;

void log_opened(double strain, const char* of, const mesh::DeformedRegularisation& opened,
                const Log& log) {
  if (opened.elements_before == 0) return;
  log(fmt::format(
      "remeshing at strain {:.6g}: {}{} thin elements opened ({} left), {} nodes of grain "
      "boundaries moved by at most {:.3g} of the grain size",
      strain, of, opened.elements_before, opened.elements_after, opened.moved,
      opened.largest_move));
}

}  // namespace

core::Vec3 meshing_scale(const mesh::Mesh& mesh, const RemeshingOptions& options) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& x : mesh.nodes) box.extend(x);
  const core::Vec3 stretch = mesh.size.cwiseQuotient(box.sizes());
  core::Vec3 scale;
  for (int a = 0; a < 3; ++a)
    scale[a] = std::pow(stretch[a],
                        stretch[a] > 1 ? options.orthotropic_share : options.lengthening_share);
  return scale;
}

mesh::Geometry regularised_geometry(const mesh::Mesh& old, const RemeshingOptions& remeshing,
                                    mesh::DeformedRegularisation& regularisation) {
  mesh::Mesh regular = old;
  regularisation = mesh::open_thin_elements(regular, meshing_scale(old, remeshing));
  mesh::Geometry geometry = mesh::geometry_of(regular);
  geometry.volumes = mesh::grain_volumes(old);
  return geometry;
}

mesh::Snapshot remesh(const mesh::Snapshot& old, const mesh::MeshingOptions& meshing,
                      const RemeshingOptions& options, mesh::MesherPool& pool, RemeshReport& report,
                      const std::function<void(const std::string&)>& log) {
  report = {};
  report.strain = old.strain;
  mesh::Geometry geometry = regularised_geometry(old.mesh, options, report.regularisation);
  mesh::Mesh mesh = mesh::mesh_geometry(geometry, meshing, meshing_scale(old.mesh, options), pool,
                                        report.meshing);
  for (const std::string& fault : report.meshing.faults) log(fault);
  for (std::size_t i = 0; i < report.meshing.copied_faces.size(); ++i)
    log(fmt::format("face {}: not remeshed, its old mesh is kept: {}",
                    report.meshing.copied_faces[i] + 1, report.meshing.why_copied[i]));
  log_opened(old.strain, "", report.regularisation, log);
  log_opened(old.strain, "of the new mesh ", report.meshing.opened, log);
  const std::string repairs = mesh::repairs_text(report.meshing);
  if (!repairs.empty()) log(fmt::format("remeshing at strain {:.6g}: {}", old.strain, repairs));
  mesh::check(mesh);
  const int threads = core::thread_count(meshing.jobs);
  mesh::Snapshot result = transport(old, std::move(mesh), options.transport, threads);
  report.beyond_limits = audit(old, result, options, report, threads);
  return result;
}

}  // namespace polyslip::remap
