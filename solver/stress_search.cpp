#include "solver/stress_search.hpp"

#include <algorithm>
#include <cmath>

namespace polyslip::solver {

StressSearch::StressSearch(const LoadProgram& program, double start)
    : target_(program.stress_target()), direction_(program.direction()), start_(start) {
  if (!target_) return;
  tolerance_ = stress_tolerance * std::max(std::abs(*target_), std::abs(start));
  drop();
}

void StressSearch::drop() {
  active_ = false;
  low_ = 0;
  if (target_) low_gap_ = direction_ * (start_ - *target_);
}

bool StressSearch::goes_on(double increment, double stress) {
  if (!target_) return false;
  const double gap = direction_ * (stress - *target_);
  met_ = std::abs(gap) <= tolerance_ || (gap > 0 && ++trials_ > max_trials);
  if (met_ || (gap < 0 && !active_)) return false;
  if (gap > 0) {
    high_ = increment;
    high_gap_ = gap;
    active_ = true;
  } else {
    ++trials_;
    low_ = increment;
    low_gap_ = gap;
  }
  const double share = std::clamp(low_gap_ / (low_gap_ - high_gap_), 0.05, 0.95);
  next_ = low_ + share * (high_ - low_);
  return true;
}

}  // namespace polyslip::solver
