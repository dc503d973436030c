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

void ReloadTracker::start(double strain, double stress_before, double slope) {
  constexpr double share = 0.99;
  state = {true, true, strain, stress_before, slope, share * stress_before, strain, 0.0};
}

ReloadTracker::Result ReloadTracker::step(double strain, double stress) {
  constexpr double reloaded = 0.01, rounding = 1e-9;
  Result result;
  if (state.ratio_due && strain >= state.start_strain + reloaded - rounding) {
    state.ratio_due = false;
    result.ratio = stress / (state.before + state.slope * (strain - state.start_strain));
  }
  if (!state.active) return result;
  if (stress >= state.target) {
    state.active = false;
    const double part = (state.target - state.last_stress) / (stress - state.last_stress);
    result.strain = state.last_strain + part * (strain - state.last_strain) - state.start_strain;
  }
  state.last_strain = strain;
  state.last_stress = stress;
  return result;
}

}  // namespace polyslip::drivers
