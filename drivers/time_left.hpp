#pragma once
// How long a run still takes: the steps it has still to take, at the pace of the last ones.

#include <vector>

#include "drivers/schedule.hpp"
#include "solver/options.hpp"

namespace polyslip::drivers {

/// Steps over `distance` of strain when the first is of `size` and they grow as `loading` says.
double steps_over(double distance, double size, const solver::LoadingOptions& loading);

/// Steps from `strain` to `end`. After each remeshing that is scheduled on the way they start from
/// initial_strain_increment again, as from zero stress; remeshings for worn elements are not
/// foreseen, nor steps that fail.
double steps_ahead(double strain, double size, double end, const std::vector<Event>& events,
                   const solver::LoadingOptions& loading);

/// Seconds from one step to the next, remeshing and output between them included: the mean of the
/// first eight, then each new one counts for an eighth.
class Pace {
 public:
  void add(double seconds);
  double mean() const { return mean_; }

 private:
  int steps_ = 0;
  double mean_ = 0;
};

}  // namespace polyslip::drivers
