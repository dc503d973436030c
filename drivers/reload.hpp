#pragma once
// How much strain the material needs to carry its stress again after a remeshing set it to zero.

#include <array>
#include <optional>

namespace polyslip::drivers {

/// von Mises equivalent of a stress in the order xx yy zz yz zx xy (plain components).
double von_mises(const std::array<double, 6>& stress);

/// Follows the volume-average von Mises stress after a remeshing until it reaches 99 % of what it
/// was before; the strain is interpolated linearly within the step.
class ReloadTracker {
 public:
  void start(double strain, double stress_before);
  /// After each step; returns the strain to reload once, when it is reached.
  std::optional<double> step(double strain, double stress);

  struct State {
    bool active = false;
    double start_strain = 0, target = 0, last_strain = 0, last_stress = 0;
  };
  State state;
};

}  // namespace polyslip::drivers
