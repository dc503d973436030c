#pragma once
// How much strain the material needs to carry its stress again after a remeshing, and whether it
// then comes back to the curve.

#include <array>
#include <optional>

namespace polyslip::drivers {

/// von Mises equivalent of a stress in the order xx yy zz yz zx xy (plain components).
double von_mises(const std::array<double, 6>& stress);

/// Follows the volume-average von Mises stress after a remeshing.
class ReloadTracker {
 public:
  /// `slope`: of the stress over the strain before.
  void start(double strain, double stress_before, double slope);

  struct Result {
    /// Once, when the stress has reached 99 % of what it was before: the strain that took, linearly
    /// interpolated within the step.
    std::optional<double> strain;
    /// Once, in the first step that ends 0.01 of strain later: the stress there over the curve
    /// before, continued in a straight line.
    std::optional<double> ratio;
  };
  /// After each step.
  Result step(double strain, double stress);

  struct State {
    bool active = false, ratio_due = false;
    double start_strain = 0, before = 0, slope = 0, target = 0, last_strain = 0, last_stress = 0;
  };
  State state;
};

}  // namespace polyslip::drivers
