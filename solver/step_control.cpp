#include "solver/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace polyslip::solver {

StepControl::StepControl(const LoadingOptions& options) : options_(options) {
  size_ = options.fixed_increment
              ? options.max_strain_increment
              : std::min(options.initial_strain_increment, options.max_strain_increment);
}

double StepControl::next_end(double strain, double target) const {
  const double left = target - strain;
  const double steps = left / size_;
  if (steps <= 1 + 1e-9) return target;
  if (steps < 2) return strain + left / 2;
  return strain + size_;
}

void StepControl::accepted(double taken) {
  // A step shortened to hit a target says nothing about a longer one.
  if (taken < size_ * (1 - 1e-9)) return;
  size_ = std::min(size_ * options_.increment_growth, options_.max_strain_increment);
}

bool StepControl::cut(double taken) {
  size_ = taken / 2;
  return size_ >= options_.min_strain_increment;
}

void StepControl::restore(const std::vector<double>& history) {
  if (history.size() != 1 || !(history[0] > 0))
    throw core::InternalError("StepControl: the stored step size is not one");
  size_ = std::max(history[0], options_.min_strain_increment);
}

}  // namespace polyslip::solver
