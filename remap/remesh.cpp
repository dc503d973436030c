#include "remap/remesh.hpp"

#include <fmt/format.h>

#include "core/parallel.hpp"
#include "remap/audit.hpp"

namespace polyslip::remap {

core::Vec3 meshing_scale(const mesh::Mesh& mesh, const RemeshingOptions& options) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& x : mesh.nodes) box.extend(x);
  return size_scale(mesh.size, box.sizes(), options.shares());
}

mesh::Geometry regularised_geometry(const mesh::Mesh& old, const RemeshingOptions& remeshing,
                                    mesh::DeformedRegularisation& regularisation) {
  // Nodes move no farther than it takes, for volumes' sake.
  constexpr double farthest = 0.5;
  mesh::DeformedRegularisationOptions options;
  mesh::Mesh regular;
  do {
    regular = old;
    regularisation = mesh::regularise_deformed(regular, meshing_scale(old, remeshing), options);
    options.largest_move *= 2;
  } while (regularisation.elements_after > 0 && options.largest_move <= farthest);
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
  const auto& opened = report.regularisation;
  if (opened.elements_before > 0)
    log(fmt::format(
        "remeshing at strain {:.6g}: {} thin elements opened ({} left), {} nodes of grain "
        "boundaries moved by at most {:.3g} of the grain size",
        old.strain, opened.elements_before, opened.elements_after, opened.moved,
        opened.largest_move));
  const std::string repairs = mesh::repairs_text(report.meshing);
  if (!repairs.empty()) log(fmt::format("remeshing at strain {:.6g}: {}", old.strain, repairs));
  mesh::check(mesh);
  const int threads = core::thread_count(meshing.jobs);
  mesh::Snapshot result = transport(old, std::move(mesh), options.transport, threads);
  report.beyond_limits = audit(old, result, options, report, threads);
  return result;
}

}  // namespace polyslip::remap
