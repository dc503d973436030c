#pragma once
// Minimisation by the limited-memory BFGS method (Nocedal, Math. Comp. 35, 1980), for functions
// that exist only near where they were last evaluated: a step that leads out of their domain is cut
// like one that does not descend.

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace polyslip::core {

struct ValueAndGradient {
  double value = 0;
  Eigen::VectorXd gradient;
};

struct LimitedMemoryOptions {
  int max_iterations = 100;
  int memory = 12;            ///< pairs of steps and gradient changes
  double first_step = 0.02;   ///< largest change of a variable in the first step
  double largest_step = 0.2;  ///< and in any step
};

/// Returns the last accepted point. `evaluate(x)`: the function at x, or nothing if it has no value
/// there. `accept()`: the point last evaluated is the new one (a caller with a state keeps it).
/// `stop(iteration)` is asked at each accepted point, the first one included. Ends too when no step
/// descends.
Eigen::VectorXd minimise(
    Eigen::VectorXd x,
    const std::function<std::optional<ValueAndGradient>(const Eigen::VectorXd& x)>& evaluate,
    const std::function<void()>& accept, const std::function<bool(int iteration)>& stop,
    const LimitedMemoryOptions& options);

}  // namespace polyslip::core
