#pragma once
// The size of the next step.

#include <string>
#include <vector>

#include "solver/options.hpp"

namespace polyslip::solver {

/// Steps grow from initial_strain_increment by increment_growth to max_strain_increment, are
/// halved on failure and hit targets exactly. With `fixed_increment` every step aims at
/// max_strain_increment from the start. No clock, no ranks: the same outcomes give the same sizes.
class StepControl {
 public:
  explicit StepControl(const LoadingOptions& options);

  /// Strain at the end of the next step from `strain` < `target`: `target` itself if it is within
  /// reach; the halfway if it is within two steps, so that no sliver is left.
  double next_end(double strain, double target) const;
  /// The step to that end was accepted.
  void accepted(double taken);
  /// It was not: the next one is half as long. False if that is below min_strain_increment.
  bool cut(double taken);

  double size() const { return size_; }
  /// For a checkpoint, and back; throws core::InternalError if `history` is not one. After a stop
  /// for steps too small the next one is of the smallest size allowed.
  std::vector<double> history() const { return {size_}; }
  void restore(const std::vector<double>& history);

 private:
  LoadingOptions options_;
  double size_;
};

}  // namespace polyslip::solver
