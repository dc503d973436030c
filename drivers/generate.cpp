#include "drivers/generate.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "drivers/mesh_files.hpp"
#include "drivers/orientations.hpp"
#include "mesh/polycrystal.hpp"
#include "mesh/tess_writer.hpp"
#include "mesh/volume_change.hpp"
#include "results/names.hpp"
#include "results/regularisation_record.hpp"

namespace polyslip::drivers {
namespace {

std::string origin_of(const Options& options) {
  const auto& o = options.polycrystal;
  const std::string& morphology = mesh::morphology_names()[static_cast<int>(o.morphology)];
  if (options.input.seeds) return *options.input.seeds;
  if (mesh::is_regular(o.morphology)) return morphology;
  return o.morphology == mesh::Morphology::voronoi ? fmt::format("seed {}", o.seed)
                                                   : fmt::format("{}, seed {}", morphology, o.seed);
}

void log_domain(const mesh::Tessellation& tessellation, const std::string& origin, core::Log& log) {
  constexpr double narrow = 0.6;  // half a grain
  const mesh::Domain& domain = tessellation.domain;
  log.info("polycrystal: {} grains, {}, {} {:.4g} x {:.4g} x {:.4g} (grains of unit mean volume)",
           tessellation.topology.cell_count(), origin,
           domain.is_box() ? "box" : domain.shape + " in a box", domain.size[0], domain.size[1],
           domain.size[2]);
  if (!(domain.facet_size > 0)) return;
  log.info("polycrystal: {} facets, {:.3g} across; their volume exceeds the {}'s by {:.3g} %{}",
           domain.face_count(), domain.facet_size, domain.shape, 100 * domain.faceting_error,
           domain.facet_size < narrow
               ? "; a grain is about 1.24 across: a larger faceting_error gives fewer elements"
               : "");
}

/// How far the making of a mesh is, from the per cent that its stages have of the time on two
/// processors (10,000 grains, docs/benchmarks.md).
class Progress {
 public:
  explicit Progress(core::Log& log) : log_(log) {}

  void operator()(const std::string& stage, double fraction) const {
    double done = 0, total = 0;
    bool before = true;
    for (const auto& [name, share] : shares) {
      total += share;
      if (name == stage) before = false, done += share * fraction;
      if (before) done += share;
    }
    log_.progress("mesh", stage, done, total);
  }

 private:
  static constexpr std::array<std::pair<std::string_view, double>, 9> shares{
      {{"tessellating", 3},
       {"regularising", 9},
       {"meshing faces", 4},
       {"meshing grains", 60},
       {"sliding nodes", 14},
       {"meshing poor grains", 1},
       {"assembling", 4},
       {"checking", 3},
       {"writing", 3}}};

  core::Log& log_;
};

mesh::Tessellation grow_laguerre(const mesh::PolycrystalOptions& options, core::Log& log,
                                 const Progress& progress) {
  mesh::LaguerreReport r;
  mesh::Tessellation tessellation = mesh::laguerre_tessellation(
      options, r, [&progress](double done) { progress("tessellating", done); });
  log.info(
      "polycrystal: equivalent diameters {:.4g}, standard deviation {:.3g} of it; sphericities "
      "{:.3f}, standard deviation {:.3f}; Kolmogorov-Smirnov distances to those asked for {:.4f} "
      "and {:.4f}; {} iterations",
      r.diameter_mean, r.diameter_deviation, r.sphericity_mean, r.sphericity_deviation,
      r.size_distance, r.sphericity_distance, r.iterations);
  return tessellation;
}

mesh::Tessellation grow(const Options& options, Input& input, const std::string& folder,
                        core::Log& log, const Progress& progress, core::StageTimes& times) {
  const bool given = input.tessellation.has_value();
  mesh::Tessellation tessellation = [&] {
    progress("tessellating", 0);
    const auto measure = times.measure("polycrystal");
    if (given) return std::move(input.tessellation->tessellation);
    if (mesh::is_laguerre(options.polycrystal.morphology))
      return grow_laguerre(options.polycrystal, log, progress);
    return mesh::voronoi_tessellation(options.polycrystal);
  }();
  log_domain(tessellation, given ? *options.input.tessellation : origin_of(options), log);
  progress("regularising", 0);
  const auto measure = times.measure("regularisation");
  const std::vector<double> volumes = mesh::cell_volumes(tessellation);
  const mesh::RegularisationReport report = mesh::regularise(tessellation, options.regularisation);
  const auto change = mesh::volume_change(volumes, mesh::cell_volumes(tessellation));
  log.info(
      "regularisation: {} of {} edges were short, {} are left; {} deletions in {} loops; {} "
      "refused for flatness, {} for folding, {} for topology, {} for polylines, {} for the domain; "
      "largest flatness fault {:.1f} degrees",
      report.short_before, report.edges_before, report.short_after, report.deleted, report.loops,
      report.refused.flatness, report.refused.fold, report.refused.topology,
      report.refused.polyline, report.refused.domain, report.max_flatness_fault);
  if (change.worst_cell >= 0)
    log.info("regularisation: grains' volumes changed by {:.2g} % rms, grain {}'s by {:+.2g} %",
             100 * change.rms, change.worst_cell + 1, 100 * change.worst);
  results::write_regularisation({.deletions = report.deleted,
                                 .short_before = report.short_before,
                                 .short_after = report.short_after,
                                 .max_flatness_fault = report.max_flatness_fault,
                                 .volume_change_rms = change.rms,
                                 .volume_change_worst = change.worst,
                                 .worst_grain = change.worst_cell + 1},
                                folder);
  tessellation.check();
  if (const auto& pairs = tessellation.topology.periodic; !pairs.empty())
    log.info("polycrystal: periodic; {} pairs of faces, {} of edges, {} of vertices",
             pairs.faces.size(), pairs.edges.size(), pairs.vertices.size());
  return tessellation;
}

std::string wins_text(const std::vector<std::string>& meshers, const std::vector<int>& wins) {
  std::string text;
  for (std::size_t i = 0; i < wins.size() && i < meshers.size(); ++i)
    text += fmt::format("{}{} {}", i ? ", " : "", meshers[i], wins[i]);
  return text;
}

void log_meshing(const mesh::Mesh& mesh, const mesh::MeshingReport& report,
                 const mesh::MeshingOptions& options, core::Log& log) {
  const mesh::QualitySummary quality = mesh::quality(mesh);
  log.info("mesh: {} elements, {} nodes; radius ratio {:.3f} worst, {:.3f} mean; mean O {:.3f}",
           mesh.element_count(), mesh.node_count(), quality.min_radius_ratio,
           quality.mean_radius_ratio, report.mean_O);
  log.info("mesh: grains won by {}", wins_text(options.meshers, report.wins));
  if (options.face_meshers.size() > 1)
    log.info("mesh: faces won by {}", wins_text(options.face_meshers, report.face_wins));
  const std::string repairs = mesh::repairs_text(report);
  if (!repairs.empty()) log.info("mesh: {}", repairs);
}

mesh::Mesh take_mesh(const Options& options, Input& input, core::Log& log) {
  mesh::Mesh mesh = std::move(input.mesh->mesh);
  const auto& t = mesh.topology;
  const mesh::QualitySummary quality = mesh::quality(mesh);
  log.info(
      "mesh: {}: {} grains with {} faces, {} edges and {} vertices; box {:.4g} x {:.4g} x {:.4g}",
      *options.input.mesh, t.cell_count(), t.faces.size(), t.edges.size(), t.vertex_count,
      mesh.size[0], mesh.size[1], mesh.size[2]);
  log.info("mesh: {} elements, {} nodes; radius ratio {:.3f} worst, {:.3f} mean",
           mesh.element_count(), mesh.node_count(), quality.min_radius_ratio,
           quality.mean_radius_ratio);
  return mesh;
}

std::string orientations_text(const Options& options, const Input& input) {
  if (input.orientations_of_input) return "those of the file";
  if (options.orientations.file) return *options.orientations.file;
  if (options.orientations.distribution == "components") return "texture components, from the seed";
  return "uniform, from the seed";
}

void read_files(const Options& options, Input& input) {
  if (options.input.tessellation) input.tessellation = mesh::read_tess(*options.input.tessellation);
  if (!options.input.mesh) return;
  input.mesh = mesh::read_msh(*options.input.mesh, options.input.length_unit);
  if (input.mesh->mesh.order != options.mesh.order)
    throw core::InputError(
        fmt::format("{}: elements of order {}, but the deck has order = {} in "
                    "[mesh]; give a mesh of that order, or change the key",
                    *options.input.mesh, input.mesh->mesh.order, options.mesh.order));
}

}  // namespace

Input read_input(const Options& options) {
  Input input;
  read_files(options, input);
  Options counted = options;
  const std::optional<std::vector<core::Quaternion>>* given = nullptr;
  if (input.tessellation) {
    counted.polycrystal.grains = input.tessellation->tessellation.topology.cell_count();
    given = &input.tessellation->orientations;
  } else if (input.mesh) {
    counted.polycrystal.grains = input.mesh->mesh.topology.cell_count();
    given = &input.mesh->orientations;
  }
  if (const auto given_sizes = options.mesh.grain_element_sizes.size();
      given_sizes != 0 && given_sizes != static_cast<std::size_t>(counted.polycrystal.grains))
    throw core::InputError(
        fmt::format("[mesh] grain_element_sizes: {} numbers for {} grains; give one a grain",
                    given_sizes, counted.polycrystal.grains));
  input.orientations_of_input =
      options.orientations.distribution == "input" && given && given->has_value();
  input.orientations = input.orientations_of_input ? **given : grain_orientations(counted);
  return input;
}

void require_box(const Options& options, const Input& input) {
  if (!input.tessellation || input.tessellation->tessellation.domain.is_box()) return;
  throw core::InputError(fmt::format(
      "{}: the tessellation fills no box; `polyslip mesh` takes it, but a run does not: "
      "loads act on the faces of a box",
      *options.input.tessellation));
}

mesh::Mesh generate_polycrystal(const Options& options, Input& input, const std::string& folder,
                                mesh::MesherPool& pool, core::Log& log, core::StageTimes& times) {
  if (options.input.any()) log.info("orientations: {}", orientations_text(options, input));
  const mesh::GrainNotes notes{.orientations = input.orientations, .ids = {}};
  if (input.mesh) {
    mesh::Mesh mesh = take_mesh(options, input, log);
    write_mesh_files(mesh, folder, 0, options.output.mesh_formats, notes);
    return mesh;
  }
  const Progress progress(log);
  const mesh::Geometry geometry = [&] {
    const mesh::Tessellation tessellation = grow(options, input, folder, log, progress, times);
    const auto measure = times.measure("output");
    mesh::write_tess(tessellation, results::in_folder(folder, results::tessellation_name),
                     {.orientations = input.orientations,
                      .ids = {},
                      .seed_weights = {},
                      .groups = {},
                      .crystal = "cubic"});
    return mesh::geometry_of(tessellation);
  }();
  const double workers = pool.cpu_seconds();
  mesh::MeshingReport report;
  mesh::Mesh mesh =
      mesh::mesh_geometry(geometry, options.mesh, core::Vec3::Ones(), pool, report, progress);
  for (const auto& [stage, seconds] : report.times.stages()) times.add(stage, seconds);
  times.add("meshing", pool.cpu_seconds() - workers);
  for (const std::string& fault : report.faults) log.warning(fault);
  log_meshing(mesh, report, options.mesh, log);
  {
    progress("checking", 0);
    const auto measure = times.measure("check");
    mesh::check(mesh, core::thread_count(options.mesh.jobs));
  }
  progress("writing", 0);
  const auto measure = times.measure("output");
  write_mesh_files(mesh, folder, 0, options.output.mesh_formats, notes);
  if (!mesh.periodic_nodes.empty())
    mesh::write_periodic_nodes(mesh, results::in_folder(folder, results::periodic_name(0)));
  progress("writing", 1);
  return mesh;
}

}  // namespace polyslip::drivers
