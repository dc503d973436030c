#pragma once
// The equations of slip where all systems share one strength g (docs/theory-material.md, (M.8) to
// (M.11), (M.15)): residual, Jacobian, Newton's step. Private to material.

#include "material/linear5.hpp"
#include "material/slip_problem.hpp"

namespace polyslip::material::simd {

/// Everything that the residual makes on its way. With x = s/g as unknown the slips do not need g,
/// so g follows from them.
struct SharedStrength {
  static constexpr int strengths = 1;
  Vec5v unknowns;  ///< x = s/g, s = C' e
  Slips slips;
  v4 g[1];         ///< end-of-step g [MPa]
  Vec5v residual;  ///< (M.11)
  v4 norm;         ///< |residual|

  v4 reduced(int i) const { return unknowns[i]; }
  /// The factor of s = scale x [MPa].
  v4 scale() const { return g[0]; }
};

inline void set_strength_unknowns(const SlipProblem<1>&, SharedStrength&) {}

/// The residual at point.unknowns.
inline void evaluate(const SlipConstants& c, double n, const SlipProblem<1>& problem,
                     SharedStrength& point) {
  v4 ratio[systems];
  resolve(c, point.unknowns, ratio);
  slips_of(c, n, problem.dt_rate, ratio, point.slips);
  point.g[0] = voce_strength(c.voce, problem.g_old[0], point.slips.total);
  point.residual = strain_residual(c, problem, point.slips, point.g[0], point.unknowns);
  point.norm = sqrt(dot(point.residual, point.residual));
}

/// The twin of evaluate, (M.15): dDg_a = compliance_a P_a . dx, dw/dx = sum compliance_a q_a P_a,
/// dg/dx = g' sum |.|'_a P_a,
/// dresidual/dx = g C'^-1 + (C'^-1 x) (dg/dx) + sum compliance_a P_a P_a - M dw/dx.
/// Symmetric positive definite but for terms of the order of the strain increments.
inline SlipJacobian jacobian(const SlipConstants& c, double, const SlipProblem<1>& problem,
                             const SharedStrength& point) {
  SlipJacobian result = slip_derivatives(c, point.slips.compliance, point.slips.slip);
  const v4 hardening =
      voce_strength_derivative(c.voce, problem.g_old[0], point.slips.total, point.g[0]);
  for (int i = 0; i < 5; ++i) result.strength[i] *= hardening;
  for (int i = 0; i < 5; ++i) {
    const double elastic_compliance = 1.0 / c.moduli[static_cast<std::size_t>(i)];
    const v4 elastic = point.unknowns[i] * elastic_compliance;
    for (int j = 0; j < 5; ++j) {
      result.rows[i][j] += elastic * result.strength[j];
      for (int k = 0; k < 3; ++k) result.rows[i][j] -= problem.turn[k][i] * result.spin[j][k];
    }
    result.rows[i][i] += point.g[0] * elastic_compliance;
  }
  return result;
}

/// What to take from point.unknowns to make the linearised residual zero.
inline Vec5v newton_step(const SlipConstants& c, double n, const SlipProblem<1>& problem,
                         const SharedStrength& point) {
  return solve(factorise(jacobian(c, n, problem, point).rows), point.residual);
}

/// The largest fraction of a step that leaves the unknowns meaningful.
inline v4 longest_fraction(const Vec5v&, const Vec5v&) { return broadcast(1.0); }

}  // namespace polyslip::material::simd
