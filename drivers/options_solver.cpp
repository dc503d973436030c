// The keys of [solver].

#include "drivers/options_sections.hpp"

namespace polyslip::drivers {

using core::Deck;

solver::SolverOptions read_solver(Deck& deck) {
  auto t = deck.table("solver", "Tolerances and limits of the equation solvers.");
  solver::SolverOptions o;
  const auto tolerance = [&](const char* key, double fallback, const char* help) {
    return t.number(
        key, {.fallback = fallback, .min = 1e-14, .max = 1, .exclusive_max = true, .help = help});
  };
  const auto count = [&](const char* key, int fallback, const char* help) {
    return static_cast<int>(
        t.integer(key, {.fallback = fallback, .min = 1, .max = 1'000'000, .help = help}));
  };
  o.newton_tolerance = tolerance(
      "newton_tolerance", o.newton_tolerance,
      "A step has converged when the forces out of balance at free nodes are this small "
      "relative to the reactions at prescribed ones (2-norms), their sums and first moments "
      "relative to the largest face force, and the volumes' mismatch (rms of ln(V/V0) - p/K) "
      "relative to the strain increment.");
  o.linear_tolerance =
      tolerance("linear_tolerance", o.linear_tolerance,
                "A linear solve ends when the 2-norm of its residual is this small relative to the "
                "2-norm of its right side.");
  o.max_newton_iterations = count("max_newton_iterations", o.max_newton_iterations,
                                  "Newton iterations of a step; beyond them the step is cut.");
  o.max_linear_iterations = count("max_linear_iterations", o.max_linear_iterations,
                                  "Iterations of a linear solve; beyond them the step is cut.");
  return o;
}

}  // namespace polyslip::drivers
