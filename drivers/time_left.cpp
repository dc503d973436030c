#include "drivers/time_left.hpp"

#include <algorithm>

namespace polyslip::drivers {

double steps_over(double distance, double size, const solver::LoadingOptions& loading) {
  double steps = 0;
  const double largest = loading.max_strain_increment;
  if (loading.fixed_increment) size = largest;
  for (; size < largest && distance > size; ++steps) {
    distance -= size;
    size = std::min(size * loading.increment_growth, largest);
  }
  return steps + std::max(distance, 0.0) / size;
}

double steps_ahead(double strain, double size, double end, const std::vector<Event>& events,
                   const solver::LoadingOptions& loading) {
  double steps = 0;
  for (const Event& event : events) {
    if (!event.remesh || event.strain <= strain + same_strain || event.strain >= end) continue;
    steps += steps_over(event.strain - strain, size, loading);
    strain = event.strain;
    size = loading.initial_strain_increment;
  }
  return steps + steps_over(end - strain, size, loading);
}

void Pace::add(double seconds) {
  constexpr int memory = 8;
  steps_ = std::min(steps_ + 1, memory);
  mean_ += (seconds - mean_) / steps_;
}

}  // namespace polyslip::drivers
