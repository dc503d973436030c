#pragma once
// What a run has counted so far; it travels in each checkpoint, so that a restart counts on.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "drivers/reload.hpp"
#include "remap/wear.hpp"
#include "results/summary.hpp"
#include "solver/model.hpp"

namespace polyslip::drivers {

/// What triggers a remeshing.
inline const std::string at_strains = "at_strains", worn_out = "worn elements",
                         failed_step = "failed step";

/// A remeshing that is due, or under way when the checkpoint was written.
struct DueRemeshing {
  std::string trigger;  ///< one of those above; empty: none is due
  std::string reason;   ///< in words

  explicit operator bool() const { return !trigger.empty(); }
};

struct RunProgress {
  long rows = 0;        ///< of macro.csv
  long states = 0;      ///< stored
  int checkpoints = 0;  ///< written
  long cuts = 0, newton_iterations = 0, linear_iterations = 0;
  long elements_initial = 0;
  bool just_remeshed = false;      ///< the next row is the first on a new mesh
  std::array<double, 6> stress{};  ///< of the last step
  double slope = 0;                ///< of the von Mises stress over the strain in it [MPa]
  std::vector<results::RemeshingSummary> remeshings;
  std::vector<results::FailedRemeshing> failed_remeshings;
  DueRemeshing due;
  remap::Wear fresh;  ///< of the present mesh when it left the mesher (no inversion_strain)
  /// Times the isotropy frame: the frame of sizes of the present mesh (remap::size_frame).
  core::Mat3 sizes = core::Mat3::Identity();
  double watch_from = 0;    ///< strain from which on worn elements are looked for
  double last_stored = -1;  ///< strain of the last stored state
  double last_attempt = 0;  ///< strain of the last remeshing, failed ones too
  ReloadTracker reload;
  std::vector<std::pair<std::string, double>> cpu_s;  ///< of sessions before this one, by stage
  double wall_s = 0;                                  ///< likewise

  /// Counts an accepted step.
  void add(const solver::StepRecord& step);
  /// Counts attempts at a step that failed.
  void add_attempts(const solver::StepRecord& tried);
  /// Back to what was, but for the attempts counted since.
  void go_back(RunProgress before);

  /// Text that holds all of it, numbers exactly.
  std::string text() const;
  /// Throws InternalError if the text is not one that `text` made.
  static RunProgress from_text(const std::string& text);
};

}  // namespace polyslip::drivers
