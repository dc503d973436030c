#include "drivers/generate.hpp"

#include "mesh/tessellation.hpp"
#include "results/names.hpp"

namespace polyslip::drivers {
namespace {

mesh::Tessellation grow(const Options& options, core::Log& log) {
  mesh::Tessellation tessellation = mesh::voronoi_tessellation(options.polycrystal);
  const core::Vec3& size = tessellation.size;
  log.info(
      "polycrystal: {} grains, seed {}, box {:.4g} x {:.4g} x {:.4g} (grains of unit mean volume)",
      options.polycrystal.grains, options.polycrystal.seed, size[0], size[1], size[2]);
  const mesh::RegularisationReport report = mesh::regularise(tessellation, options.regularisation);
  log.info(
      "regularisation: {} of {} edges were short, {} are left; {} deletions in {} loops; {} "
      "refused for flatness, {} for topology; largest flatness fault {:.1f} degrees",
      report.short_before, report.edges_before, report.short_after, report.deleted, report.loops,
      report.refused_flatness, report.refused_topology, report.max_flatness_fault);
  tessellation.check();
  return tessellation;
}

void log_meshing(const mesh::Mesh& mesh, const mesh::MeshingReport& report,
                 const std::vector<std::string>& meshers, core::Log& log) {
  const mesh::QualitySummary quality = mesh::quality(mesh);
  log.info("mesh: {} elements, {} nodes; radius ratio {:.3f} worst, {:.3f} mean; mean O {:.3f}",
           mesh.element_count(), mesh.node_count(), quality.min_radius_ratio,
           quality.mean_radius_ratio, report.mean_O);
  std::string wins;
  for (std::size_t i = 0; i < report.wins.size() && i < meshers.size(); ++i)
    wins += fmt::format("{}{} {}", i ? ", " : "", meshers[i], report.wins[i]);
  log.info("mesh: grains won by {}", wins);
  const std::string repairs = mesh::repairs_text(report);
  if (!repairs.empty()) log.info("mesh: {}", repairs);
}

}  // namespace

mesh::Mesh generate_polycrystal(const Options& options, const std::string& folder,
                                mesh::MesherPool& pool, core::Log& log, core::StageTimes& times) {
  const mesh::Tessellation tessellation = [&] {
    const auto measure = times.measure("polycrystal");
    return grow(options, log);
  }();
  mesh::write_tess(tessellation, results::in_folder(folder, results::tessellation_name));

  const auto measure = times.measure("meshing");
  const double workers = pool.cpu_seconds();
  mesh::MeshingReport report;
  mesh::Mesh mesh =
      mesh::mesh_geometry(mesh::geometry_of(tessellation), options.mesh, core::Vec3::Ones(), pool,
                          report, [&log](double done) { log.progress("meshing", done, 1); });
  times.add("meshing", pool.cpu_seconds() - workers);
  for (const std::string& fault : report.faults) log.warning(fault);
  log_meshing(mesh, report, options.mesh.meshers, log);
  mesh::check(mesh);
  mesh::write_msh(mesh, results::in_folder(folder, results::mesh_name(0)));
  return mesh;
}

}  // namespace polyslip::drivers
