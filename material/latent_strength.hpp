#pragma once
// The equations of slip where each system has a strength g_a of its own (docs/theory-material.md,
// (M.8), (M.10), (M.11), (M.19) to (M.22)): residual, Jacobian, Newton's step. Private to material.

#include "material/linear5.hpp"
#include "material/slip_problem.hpp"

namespace polyslip::material::simd {

/// Everything that the residual makes on its way. Unknowns are x = s/g_r and rho_a = g_a/g_r with
/// g_r the mean of the twelve g_n: seventeen, of which twelve are eliminated by hand.
struct LatentStrength {
  static constexpr int strengths = systems;
  Vec<5 + systems> unknowns;  ///< x, then rho
  Slips slips;
  v4 reference;           ///< g_r [MPa]
  v4 hardening[systems];  ///< H_a = sum_b q_ab |Dg_b|
  v4 g[systems];          ///< of Voce's law after H_a [MPa]
  Vec5v residual;         ///< (M.11)
  v4 lag[systems];        ///< rho_a - g_a/g_r, (M.19)
  v4 norm;                ///< of residual and, times |De_c| + |e_n|, of lag

  v4 reduced(int i) const { return unknowns[i]; }
  v4 scale() const { return reference; }
};

inline void set_strength_unknowns(const SlipProblem<systems>& problem, LatentStrength& point) {
  for (int a = 0; a < systems; ++a) point.unknowns[5 + a] = problem.ratio_old(a);
}

inline Vec5v reduced_stress(const LatentStrength& point) {
  Vec5v x;
  for (int i = 0; i < 5; ++i) x[i] = point.unknowns[i];
  return x;
}

/// The residual at point.unknowns.
inline void evaluate(const SlipConstants& c, double n, const SlipProblem<systems>& problem,
                     LatentStrength& point) {
  const Vec5v x = reduced_stress(point);
  v4 ratio[systems];
  resolve(c, x, ratio);
  for (int a = 0; a < systems; ++a) ratio[a] /= point.unknowns[5 + a];
  slips_of(c, n, problem.dt_rate, ratio, point.slips);
  point.reference = problem.mean_g_old;
  const v4 inverse = 1.0 / point.reference;
  v4 lags = broadcast(0.0);
  for (int a = 0; a < systems; ++a) {
    point.hardening[a] = c.latent * point.slips.total + (1.0 - c.latent) * abs(point.slips.slip[a]);
    point.g[a] = voce_strength(c.voce, problem.g_old[a], point.hardening[a]);
    point.lag[a] = point.unknowns[5 + a] - point.g[a] * inverse;
    lags += point.lag[a] * point.lag[a];
  }
  point.residual = strain_residual(c, problem, point.slips, point.reference, x);
  const v4 size = sqrt(dot(problem.strain, problem.strain)) +
                  sqrt(dot(problem.elastic_old, problem.elastic_old));
  point.norm = sqrt(dot(point.residual, point.residual) + size * size * lags);
}

/// The slips linearised with the strengths eliminated, (M.20) and (M.21).
struct LatentElimination {
  v4 softening[systems];   ///< nu_a = n |Dg_a|/rho_a
  v4 hardening[systems];   ///< beta_a = dg_a/dH_a/g_r
  v4 factor[systems];      ///< f_a = 1/(1 + nu_a beta_a (1 - q))
  v4 compliance[systems];  ///< f_a dDg_a/d(tau_a/g_a)/rho_a
  v4 border;               ///< 1/(1 + q sum f_a nu_a beta_a)
};

inline LatentElimination eliminate(const SlipConstants& c, double n,
                                   const SlipProblem<systems>& problem,
                                   const LatentStrength& point) {
  LatentElimination e;
  v4 sum = broadcast(0.0);
  for (int a = 0; a < systems; ++a) {
    const v4 inverse_ratio = 1.0 / point.unknowns[5 + a];
    e.softening[a] = n * abs(point.slips.slip[a]) * inverse_ratio;
    e.hardening[a] =
        voce_strength_derivative(c.voce, problem.g_old[a], point.hardening[a], point.g[a]) /
        point.reference;
    const v4 coupling = e.softening[a] * e.hardening[a];
    e.factor[a] = 1.0 / (1.0 + (1.0 - c.latent) * coupling);
    e.compliance[a] = e.factor[a] * point.slips.compliance[a] * inverse_ratio;
    sum += e.factor[a] * coupling;
  }
  e.border = 1.0 / (1.0 + c.latent * sum);
  return e;
}

/// sum_a sgn_a amount_a (P_a - M q_a) and sum_a sgn_a amount_a q_a.
inline Vec5v strain_of(const SlipConstants& c, const SlipProblem<systems>& problem,
                       const LatentStrength& point, const v4* amount, Vec3v& spin) {
  Vec5v strain = {};
  spin = {};
  for (std::size_t a = 0; a < systems; ++a) {
    const v4 slip = amount[a] * copysign(broadcast(1.0), point.slips.slip[a]);
    for (int i = 0; i < 5; ++i) strain[i] += slip * c.schmid[a][static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) spin[k] += slip * c.spin[a][static_cast<std::size_t>(k)];
  }
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 3; ++k) strain[i] -= problem.turn[k][i] * spin[k];
  }
  return strain;
}

/// (M.22), with dGamma/dx handed out beside it.
inline SlipJacobian jacobian(const SlipConstants& c, const SlipProblem<systems>& problem,
                             const LatentStrength& point, const LatentElimination& e,
                             Vec5v& total) {
  SlipJacobian result = slip_derivatives(c, e.compliance, point.slips.slip);
  for (int i = 0; i < 5; ++i) total[i] = e.border * result.strength[i];
  v4 relief[systems];  // -d|Dg_a|/dGamma
  for (int a = 0; a < systems; ++a) {
    relief[a] = c.latent * e.factor[a] * e.softening[a] * e.hardening[a];
  }
  Vec3v relief_spin;
  const Vec5v relief_strain = strain_of(c, problem, point, relief, relief_spin);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) {
      for (int k = 0; k < 3; ++k) result.rows[i][j] -= problem.turn[k][i] * result.spin[j][k];
      result.rows[i][j] -= relief_strain[i] * total[j];
    }
    for (int k = 0; k < 3; ++k) result.spin[j][k] -= relief_spin[k] * total[j];
    result.rows[j][j] += point.reference * (1.0 / c.moduli[static_cast<std::size_t>(j)]);
    result.strength[j] = broadcast(0.0);
  }
  return result;
}

/// The twin of evaluate: derivatives while every g_a follows its equation.
inline SlipJacobian jacobian(const SlipConstants& c, double n, const SlipProblem<systems>& problem,
                             const LatentStrength& point) {
  Vec5v total;
  return jacobian(c, problem, point, eliminate(c, n, problem, point), total);
}

/// What to take from point.unknowns to make residual and lag zero when linearised.
inline Vec<5 + systems> newton_step(const SlipConstants& c, double n,
                                    const SlipProblem<systems>& problem,
                                    const LatentStrength& point) {
  const LatentElimination e = eliminate(c, n, problem, point);
  Vec5v total;
  const SlipJacobian derivative = jacobian(c, problem, point, e, total);
  // d|Dg_a| = f_a (sgn_a compliance_a P_a . dx/rho_a + nu_a (lag_a - q beta_a dGamma)), where what
  // is taken from the unknowns counts as positive
  v4 extra = broadcast(0.0);
  for (int a = 0; a < systems; ++a) extra -= e.factor[a] * e.softening[a] * point.lag[a];
  extra *= e.border;  // of dGamma, at dx = 0
  v4 moved[systems];
  for (int a = 0; a < systems; ++a) {
    moved[a] = -e.factor[a] * e.softening[a] * (point.lag[a] + c.latent * e.hardening[a] * extra);
  }
  Vec3v spin;
  Vec5v x = strain_of(c, problem, point, moved, spin);
  for (int i = 0; i < 5; ++i) x[i] = point.residual[i] - x[i];
  x = solve(factorise(derivative.rows), x);
  const v4 total_change = dot(total, x) + extra;
  v4 resolved[systems];
  resolve(c, x, resolved);
  Vec<5 + systems> step;
  for (int i = 0; i < 5; ++i) step[i] = x[i];
  for (int a = 0; a < systems; ++a) {
    const v4 change =
        e.compliance[a] * resolved[a] * copysign(broadcast(1.0), point.slips.slip[a]) -
        e.factor[a] * e.softening[a] * (point.lag[a] + c.latent * e.hardening[a] * total_change);
    step[5 + a] =
        point.lag[a] + e.hardening[a] * (c.latent * total_change + (1.0 - c.latent) * change);
  }
  return step;
}

/// The largest fraction of a step, 1 at most, that halves no rho_a.
inline v4 longest_fraction(const Vec<5 + systems>& start, const Vec<5 + systems>& step) {
  v4 fraction = broadcast(1.0);
  for (int a = 5; a < 5 + systems; ++a) {
    const v4 limit = 0.5 * start[a];
    fraction = select(fraction * step[a] > limit, limit / step[a], fraction);
  }
  return fraction;
}

}  // namespace polyslip::material::simd
