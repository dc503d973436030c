// The keys of [solver].

#include <fmt/ranges.h>

#include <algorithm>

#include "drivers/options_sections.hpp"
#include "mesh/quadrature.hpp"

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
  o.element = t.text(
      "element",
      {.fallback = o.element,
       .choices = {"mixed", "displacement", "displacement-straight"},
       .help = "mixed: ten-node tetrahedra with one constant pressure each. displacement: the "
               "same without a pressure of its own, for comparison with other programs: it is too "
               "stiff, and its stresses oscillate. displacement-straight: that on the straight "
               "tetrahedra of the corners, whatever the mid nodes do, as FEPX has it."});
  o.quadrature_points = static_cast<int>(t.integer(
      "quadrature_points",
      {.fallback = o.quadrature_points,
       .min = 1,
       .help = "Points of an element that carry state: 4, 8, 14 or 15, exact for polynomials of "
               "degree 2, 3, 5 and 5, all with positive weights. The first of 15 is the centroid. "
               "Time and memory grow with them."}));
  const auto& known = mesh::tet_quadrature_sizes;
  if (std::find(known.begin(), known.end(), o.quadrature_points) == known.end())
    t.fault("quadrature_points", fmt::format("quadrature_points = {} must be one of {}",
                                             o.quadrature_points, fmt::join(known, ", ")));
  o.newton_tolerance = tolerance(
      "newton_tolerance", o.newton_tolerance,
      "A step has converged when the forces out of balance at free nodes are this small "
      "relative to the reactions at prescribed ones (root mean squares), their sums and first "
      "moments "
      "relative to the largest face force, and the volumes' mismatch (rms of ln(V/V0) - p/K) "
      "relative to the strain increment.");
  o.velocity_tolerance =
      tolerance("velocity_tolerance", o.velocity_tolerance,
                "... and when the last Newton iteration moved the nodes by no more than this, "
                "relative to their displacements in the step (2-norms).");
  o.linear_tolerance =
      tolerance("linear_tolerance", o.linear_tolerance,
                "A linear solve ends when the 2-norm of its residual is this small relative to the "
                "2-norm of its right side; or up to ten times this where Newton's method would "
                "gain nothing by more.");
  o.max_newton_iterations = count("max_newton_iterations", o.max_newton_iterations,
                                  "Newton iterations of a step; beyond them the step is cut.");
  o.max_linear_iterations = count("max_linear_iterations", o.max_linear_iterations,
                                  "Iterations of a linear solve; beyond them the step is cut.");
  return o;
}

}  // namespace polyslip::drivers
