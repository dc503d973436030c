#pragma once
// summary.json of a run or a meshing.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace polyslip::results {

/// The body on one side of a remeshing.
struct RemeshedState {
  double mean_spread = 0;        ///< mean angle from a grain's mean, over the grains [degrees]
  std::array<double, 3> g{};     ///< mean, least, largest [MPa]
  std::array<double, 3> slip{};  ///< likewise
  double elastic_energy = 0;     ///< MPa L^3
  /// L^3; checkpoints of earlier versions have none.
  std::optional<double> volume, volume_at_zero_pressure;
};

struct RemeshingSummary {
  double strain = 0;
  long elements_before = 0, elements_after = 0;
  double min_radius_ratio_before = 0, min_radius_ratio_after = 0;
  double max_grain_volume_change = 0;      ///< relative
  std::optional<double> strain_to_reload;  ///< until the stress is back at the curve before
  /// Stress 0.01 of strain later over the curve before, continued in a straight line.
  std::optional<double> reloaded_stress_ratio;
  double rms_grain_volume_change = 0;                      ///< relative
  double mean_grain_rotation = 0, max_grain_rotation = 0;  ///< of mean orientations [degrees]
  double max_spread_change = 0;                            ///< of a grain [degrees]
  RemeshedState before, after;
  double stress_before = 0;  ///< von Mises, MPa
  std::string trigger;       ///< "at_strains", "worn elements", "failed step"
  std::string reason;        ///< in words
  int attempts = 1;          ///< until it succeeded
  int copied_faces = 0;
};

/// A remeshing after which the run went on, or ended, on the old mesh.
struct FailedRemeshing {
  double strain = 0;
  std::string reason;
};

/// Of a Taylor model: factors of its initial orientations (drivers/taylor.hpp).
struct TaylorSummary {
  double initial_stress = 0;  ///< von Mises work per strain over g
  double initial_slip = 0;    ///< sum of |slip| per von Mises strain
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
  std::optional<TaylorSummary> taylor;
};

/// A remeshing as JSON, numbers exactly, and back; throws InternalError for another text.
std::string remeshing_text(const RemeshingSummary& remeshing);
RemeshingSummary remeshing_from_text(const std::string& text);

/// The JSON text, schema "polyslip-summary/1". Numbers that are not finite become null.
std::string summary_text(const Summary& summary);

/// Writes it, whole or not at all. InputError if that is impossible.
void write_summary(const std::string& path, const Summary& summary);

}  // namespace polyslip::results
