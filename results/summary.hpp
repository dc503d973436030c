#pragma once
// summary.json of a run or a meshing.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace polyslip::results {

struct RemeshingSummary {
  double strain = 0;
  long elements_before = 0, elements_after = 0;
  double min_radius_ratio_before = 0, min_radius_ratio_after = 0;
  double max_grain_volume_change = 0;      ///< relative
  std::optional<double> strain_to_reload;  ///< until the stress is back at the curve before
  std::string trigger;                     ///< "at_strains", "worn elements", "failed step"
  std::string reason;                      ///< in words
  int attempts = 1;                        ///< until it succeeded
  int copied_faces = 0;
};

/// A remeshing after which the run went on, or ended, on the old mesh.
struct FailedRemeshing {
  double strain = 0;
  std::string reason;
};

/// What is not set does not apply (a meshing has no final strain) and is left out.
struct Summary {
  std::optional<bool> completed;
  std::optional<double> final_strain;
  std::optional<int> grains;
  std::optional<long> elements_initial, elements_final, nodes_initial, nodes_final;
  std::optional<long> steps, step_cuts, newton_iterations, linear_iterations;
  std::optional<std::vector<RemeshingSummary>> remeshings;
  std::optional<std::vector<FailedRemeshing>> failed_remeshings;
  std::optional<std::array<std::array<double, 3>, 3>> stress_final_mpa;  ///< volume average
  std::optional<double> min_radius_ratio, mean_radius_ratio;
  std::map<std::string, double> cpu_s;  ///< by stage, all ranks and workers
  std::optional<double> wall_s;
  std::optional<double> peak_rss_mb;
  std::string version;
  std::optional<std::uint64_t> seed;
};

/// The JSON text, schema "polyslip-summary/1". Numbers that are not finite become null.
std::string summary_text(const Summary& summary);

/// Writes it, whole or not at all. InputError if that is impossible.
void write_summary(const std::string& path, const Summary& summary);

}  // namespace polyslip::results
