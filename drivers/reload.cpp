#include "drivers/reload.hpp"

#include <cmath>

namespace polyslip::drivers {

double von_mises(const std::array<double, 6>& s) {
  const double mean = (s[0] + s[1] + s[2]) / 3;
  const double normal =
      std::pow(s[0] - mean, 2) + std::pow(s[1] - mean, 2) + std::pow(s[2] - mean, 2);
  const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return std::sqrt(1.5 * (normal + 2 * shear));
}

void ReloadTracker::start(double strain, double stress_before) {
  constexpr double share = 0.99;
  state = {true, strain, share * stress_before, strain, 0.0};
}

std::optional<double> ReloadTracker::step(double strain, double stress) {
  if (!state.active) return std::nullopt;
  if (stress < state.target) {
    state.last_strain = strain;
    state.last_stress = stress;
    return std::nullopt;
  }
  state.active = false;
  const double part = (state.target - state.last_stress) / (stress - state.last_stress);
  return state.last_strain + part * (strain - state.last_strain) - state.start_strain;
}

}  // namespace polyslip::drivers
