#include "drivers/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/rotation.hpp"
#include "core/version.hpp"
#include "drivers/report_verb.hpp"
#include "results/names.hpp"
#include "results/picture.hpp"
#include "results/state_file.hpp"

namespace polyslip::drivers {
namespace {

/// Every stage that any rank measures, in the order of the pipeline.
const std::vector<std::string>& stages() {
  static const std::vector<std::string> names{"polycrystal", "meshing", "deformation", "remeshing",
                                              "output"};
  return names;
}

double seconds_of(const CpuSeconds& times, const std::string& stage) {
  for (const auto& [name, seconds] : times)
    if (name == stage) return seconds;
  return 0;
}

/// Of a grain on one side of a remeshing; two columns of the table.
struct GrainColumn {
  const char* name;
  double (*of)(const remap::GrainStatistics&);
};

/// The volume, after which the rotation stands, and the rest.
const std::pair<GrainColumn, std::vector<GrainColumn>>& grain_columns() {
  using Grain = const remap::GrainStatistics&;
  static const std::pair<GrainColumn, std::vector<GrainColumn>> columns{
      {"volume", [](Grain g) { return g.volume; }},
      {{"spread", [](Grain g) { return g.spread; }},
       {"g", [](Grain g) { return g.g.mean; }},
       {"g_min", [](Grain g) { return g.g.min; }},
       {"g_max", [](Grain g) { return g.g.max; }},
       {"slip", [](Grain g) { return g.slip.mean; }},
       {"slip_min", [](Grain g) { return g.slip.min; }},
       {"slip_max", [](Grain g) { return g.slip.max; }},
       {"elastic_energy", [](Grain g) { return g.elastic_energy; }},
       {"volume_at_zero_pressure", [](Grain g) { return g.volume_at_zero_pressure; }}}};
  return columns;
}

}  // namespace

std::string step_text(const solver::StepRecord& step, double seconds_left) {
  return fmt::format(
      "strain {:.5f}  stress {:7.3f} MPa  step {:.2e}  Newton {:2d}  linear {:3d}  "
      "worst element {:.3f}{}  {} left",
      step.strain, von_mises(step.stress), step.step_size, step.newton_iterations,
      step.linear_iterations, step.min_jacobian_ratio,
      step.cuts > 0 ? fmt::format("  {} cuts", step.cuts) : "", core::duration_text(seconds_left));
}

std::string remeshing_text(const remap::RemeshReport& r) {
  return fmt::format(
      "remeshing at strain {:.4g}: {} elements -> {}; worst radius ratio, in the frame of sizes, "
      "{:.3f} -> {:.3f}; grain "
      "volumes changed by {:.3f} % rms, {:.3f} % at worst; mean orientations of grains moved by "
      "{:.3f} degrees on average, {:.3f} at worst; spreads {:.3f} -> {:.3f} degrees, {:.3f} at "
      "worst; mean g {:.3f} -> {:.3f} MPa; mean slip {:.4f} -> {:.4f}; elastic energy {:.4g} -> "
      "{:.4g}; {} faces copied",
      r.strain, r.elements_before, r.elements_after, r.min_radius_ratio_before,
      r.min_radius_ratio_after, 100 * r.rms_grain_volume_change, 100 * r.max_grain_volume_change,
      r.mean_mean_rotation, r.max_mean_rotation, r.before.mean_spread, r.after.mean_spread,
      r.max_spread_change, r.before.g.mean, r.after.g.mean, r.before.slip.mean, r.after.slip.mean,
      r.before.elastic_energy, r.after.elastic_energy, r.meshing.copied_faces.size());
}

results::RemeshingSummary remeshing_summary(const remap::RemeshReport& r) {
  const auto side = [](const remap::BodyStatistics& b) {
    return results::RemeshedState{b.mean_spread,
                                  {b.g.mean, b.g.min, b.g.max},
                                  {b.slip.mean, b.slip.min, b.slip.max},
                                  b.elastic_energy,
                                  b.volume,
                                  b.volume_at_zero_pressure};
  };
  results::RemeshingSummary s;
  s.strain = r.strain;
  s.elements_before = r.elements_before;
  s.elements_after = r.elements_after;
  s.min_radius_ratio_before = r.min_radius_ratio_before;
  s.min_radius_ratio_after = r.min_radius_ratio_after;
  s.max_grain_volume_change = r.max_grain_volume_change;
  s.rms_grain_volume_change = r.rms_grain_volume_change;
  s.mean_grain_rotation = r.mean_mean_rotation;
  s.max_grain_rotation = r.max_mean_rotation;
  s.max_spread_change = r.max_spread_change;
  s.before = side(r.before);
  s.after = side(r.after);
  s.copied_faces = static_cast<int>(r.meshing.copied_faces.size());
  return s;
}

std::string remeshing_table(const remap::RemeshReport& r) {
  std::string table = "grain";
  const auto add_header = [&](const GrainColumn& c) {
    table += fmt::format(",{0}_before,{0}_after", c.name);
  };
  const auto& [volume, others] = grain_columns();
  add_header(volume);
  table += ",rotation";
  for (const auto& column : others) add_header(column);
  for (std::size_t i = 0; i < r.grains_before.size(); ++i) {
    const remap::GrainStatistics &a = r.grains_before[i], &b = r.grains_after[i];
    const double rotation = a.orientation.angularDistance(b.orientation) * core::degrees_per_radian;
    table += fmt::format("\n{},{},{},{}", i + 1, volume.of(a), volume.of(b), rotation);
    for (const auto& column : others) table += fmt::format(",{},{}", column.of(a), column.of(b));
  }
  return table + "\n";
}

CpuSeconds total_times(const CpuSeconds& earlier, const core::StageTimes& times) {
  CpuSeconds result;
  for (const std::string& stage : stages())
    result.emplace_back(stage, seconds_of(earlier, stage) + times.seconds(stage));
  return result;
}

CpuSeconds sum_over_ranks(MPI_Comm comm, const CpuSeconds& earlier, const core::StageTimes& times) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  CpuSeconds result = total_times(rank == 0 ? earlier : CpuSeconds{}, times);
  for (auto& [stage, seconds] : result) seconds = sum_over_ranks(comm, seconds);
  return result;
}

double sum_over_ranks(MPI_Comm comm, double value) {
  double sum = 0;
  MPI_Allreduce(&value, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
  return sum;
}

results::Summary summarise(const RunProgress& progress, const Options& options,
                           const mesh::Snapshot& last) {
  results::Summary s;
  s.final_strain = last.strain;
  s.grains = last.mesh.topology.cell_count();
  s.elements_initial = progress.elements_initial;
  s.elements_final = last.mesh.element_count();
  s.nodes_final = last.mesh.node_count();
  s.steps = progress.rows;
  s.step_cuts = progress.cuts;
  s.newton_iterations = progress.newton_iterations;
  s.linear_iterations = progress.linear_iterations;
  s.remeshings = progress.remeshings;
  s.failed_remeshings = progress.failed_remeshings;
  const auto& t = progress.stress;
  s.stress_final_mpa = {{{t[0], t[5], t[4]}, {t[5], t[1], t[3]}, {t[4], t[3], t[2]}}};
  s.version = core::version();
  s.seed = options.polycrystal.seed;
  return s;
}

void report_end(const std::string& folder, const results::StateSeries& states,
                const results::Summary& summary, core::Log& log) {
  const std::string picture = results::in_folder(folder, results::picture_name);
  results::write_picture(picture, results::read_state(states.path(states.states().front())),
                         results::read_state(states.path(states.states().back())));
  std::string remeshings;
  for (const auto& r : *summary.remeshings)
    remeshings += fmt::format("{}{:.4g}", remeshings.empty() ? "" : ", ", r.strain);
  log.info(
      "summary: {} grains, {} elements at strain {:.4g} after {} steps, {} cuts, {} Newton and {} "
      "linear iterations; remeshed at {}; {:.0f} s of wall time",
      *summary.grains, *summary.elements_final, *summary.final_strain, *summary.steps,
      *summary.step_cuts, *summary.newton_iterations, *summary.linear_iterations,
      remeshings.empty() ? "no strain" : remeshings, *summary.wall_s);
  log.info("results: {}", results::in_folder(folder, results::xdmf_name));
  log.info("picture: {}", picture);
}

void make_report(const std::string& folder, const TextureOptions& texture, core::Log& log) {
  try {
    log.info("report: {}", write_report({.folder = folder, .overwrite = true}, texture));
  } catch (const std::exception& e) {
    log.warning(fmt::format("no report: {}", e.what()));
  }
}

}  // namespace polyslip::drivers
