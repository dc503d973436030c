#pragma once
// The step that ends a stage at its target of stress.

#include <optional>

#include "solver/load_program.hpp"

namespace polyslip::solver {

/// Follows the trials of one step. A converged trial that passes the target by more than
/// `stress_tolerance` is not accepted; shorter ones are tried (regula falsi in the increment, kept
/// in the inner nine tenths of the bracket) until one meets it.
class StressSearch {
 public:
  /// Relative to the target or the stress before the step, whichever is larger.
  static constexpr double stress_tolerance = 1e-3;
  static constexpr int max_trials = 20;

  /// start: load stress before the step [MPa]
  StressSearch(const LoadProgram& program, double start);

  /// A trial of this increment of path converged at this load stress. True: try `increment()`
  /// next; false: accept the trial.
  bool goes_on(double increment, double stress);
  /// Whether the accepted trial meets the target.
  bool met() const { return met_; }
  bool active() const { return active_; }
  double increment() const { return next_; }
  /// A trial failed: its bracket says nothing.
  void drop();

 private:
  std::optional<double> target_;
  int direction_, trials_ = 0;
  double start_, tolerance_ = 0;
  double low_ = 0, low_gap_ = 0, high_ = 0, high_gap_ = 0;  // increment, stress beyond the target
  double next_ = 0;
  bool active_ = false, met_ = false;
};

}  // namespace polyslip::solver
