#pragma once
// Solution of the implicit equations of slip at a point (docs/theory-material.md, "Solver"): start,
// Newton's method with a monotone line search, continuation in the exponent. Private to material.

#include "material/latent_strength.hpp"
#include "material/shared_strength.hpp"

namespace polyslip::material::simd {

/// SlipProblem of SharedStrength or LatentStrength.
template <class Strength>
using Problem = SlipProblem<Strength::strengths>;

/// The elastic trial stress over the mean of g_n, drawn back along itself to where the incremental
/// potential s.C'^-1 s/2 - s.e_trial + sum Dg_a tau_a/(n + 1) is least on that ray, at g_a = g_n.
/// The last term is homogeneous in s, so one evaluation of the powers is enough.
template <int strengths>
inline Vec5v clipped_trial(const SlipConstants& c, double n,
                           const SlipProblem<strengths>& problem) {
  Vec5v trial, x;
  for (int i = 0; i < 5; ++i) {
    trial[i] = problem.elastic_old[i] + problem.strain[i];
    x[i] = trial[i] * c.moduli[static_cast<std::size_t>(i)] / problem.mean_g_old;
  }
  v4 ratio[systems];
  resolve(c, x, ratio);
  for (int a = 0; a < systems; ++a) ratio[a] /= problem.ratio_old(a);
  v4 largest = broadcast(1e-200);
  for (const v4& r : ratio) largest = max(largest, abs(r));
  v4 work = broadcast(0.0);  // sum Dg_a tau_a/g_r where the largest |tau_a|/g_a is 1
  for (int a = 0; a < systems; ++a) {
    work += problem.ratio_old(a) *
            exp((n + 1.0) * log(max(abs(ratio[a]) / largest, broadcast(1e-300))));
  }
  work *= problem.dt_rate;
  // With x = mu x_trial/largest: elastic mu + work mu^n = elastic largest; y = ln mu
  const v4 elastic = max(dot(trial, x) / (largest * largest), broadcast(1e-200));
  const v4 load = elastic * largest;
  const v4 limit = log(largest);
  v4 y = min(limit, log(max(load / max(work, broadcast(1e-200)), broadcast(1e-200))) * (1.0 / n));
  for (int iteration = 0; iteration < 3; ++iteration) {
    const v4 linear = elastic * exp(y), power = work * exp(n * y);
    y -= (linear + power - load) / (linear + n * power);
  }
  const v4 factor = exp(min(y - limit, broadcast(0.0)));
  for (int i = 0; i < 5; ++i) x[i] *= factor;
  return x;
}

inline constexpr double relative_tolerance = 1e-12;
inline constexpr int max_evaluations = 200;  ///< of the residual in one Newton solve

/// Newton's method for residual = 0 from `point`, which is evaluated, with backtracking until
/// |residual| falls: Armijo's rule with the fraction 1e-4, step factors from the parabola through
/// value, slope and the rejected value, kept in [0.1, 0.5]. A lane that has reached `tolerance` or
/// cannot fall any more stands still: later evaluations repeat its last one bit for bit, so that no
/// lane depends on its neighbours. On return `point` is evaluated; the lanes that converged are
/// returned.
template <class Strength>
inline m4 newton(const SlipConstants& c, double n, const Problem<Strength>& problem, v4 tolerance,
                 Strength& point) {
  m4 open = ~(point.norm <= tolerance);
  for (int evaluation = 0; evaluation < max_evaluations && any(open);) {
    const auto step = newton_step(c, n, problem, point);
    const auto start = point.unknowns;
    const v4 norm = point.norm;
    v4 factor = select(open, longest_fraction(start, step), broadcast(0.0));
    m4 search = open;
    while (any(search) && evaluation < max_evaluations) {
      for (std::size_t i = 0; i < std::size(start.a); ++i) {
        point.unknowns.a[i] = select(open, start.a[i] - factor * step.a[i], start.a[i]);
      }
      evaluate(c, n, problem, point);
      ++evaluation;
      search = search & ~(point.norm <= (1.0 - 1e-4 * factor) * norm);
      const v4 fall = norm * norm * factor;
      v4 shrink = fall / (point.norm * point.norm - norm * norm + 2.0 * fall);
      shrink = select(shrink < 0.5, shrink, broadcast(0.5));
      shrink = select(shrink > 0.1, shrink, broadcast(0.1));
      factor = select(search, factor * shrink, factor);
      const m4 stuck = search & (factor < 1e-12);
      search = search & ~stuck;
      open = open & ~stuck;
    }
    open = open & ~(point.norm <= tolerance);
  }
  return point.norm <= tolerance;
}

/// x = s/g_r at the start of a solution, with the strengths of n.
template <class Strength>
inline void start_at(const Vec5v& x, const Problem<Strength>& problem, Strength& point) {
  for (int i = 0; i < 5; ++i) point.unknowns[i] = x[i];
  set_strength_unknowns(problem, point);
}

/// The lanes of `m` of a, the others of b.
template <int n>
inline Vec<n> select(m4 m, const Vec<n>& a, const Vec<n>& b) {
  Vec<n> result;
  for (int i = 0; i < n; ++i) result[i] = select(m, a[i], b[i]);
  return result;
}

/// Solves a step. The start is the old stress, or the clipped trial stress where the old one leaves
/// more than half the strain increment as residual and the trial less than it. Should a lane fail,
/// the whole block is solved again by continuation in the exponent (4, 8, 16, ... n), which only
/// lanes that failed take over. Tolerance on |residual|: relative_tolerance g_n/max(C') plus what
/// rounding leaves of the strains and powers.
template <class Strength>
inline m4 solve_slip(const SlipConstants& c, const Problem<Strength>& problem, Strength& point) {
  double stiffest = c.moduli[0];
  for (const double modulus : c.moduli) stiffest = modulus > stiffest ? modulus : stiffest;
  const v4 increment = sqrt(dot(problem.strain, problem.strain));
  const v4 size = increment + sqrt(dot(problem.elastic_old, problem.elastic_old));
  const v4 tolerance =
      problem.mean_g_old * (relative_tolerance / stiffest) + size * (8 * 2.2e-16 * c.exponent);
  Vec5v old;
  for (int i = 0; i < 5; ++i) {
    old[i] = problem.elastic_old[i] * c.moduli[static_cast<std::size_t>(i)] / problem.mean_g_old;
  }
  start_at(old, problem, point);
  evaluate(c, c.exponent, problem, point);
  const m4 far = ~(point.norm <= 0.5 * increment);
  if (any(far)) {
    Strength other;
    start_at(clipped_trial(c, c.exponent, problem), problem, other);
    evaluate(c, c.exponent, problem, other);
    const m4 better = far & (other.norm < point.norm);
    point.unknowns = select(better, other.unknowns, point.unknowns);
    evaluate(c, c.exponent, problem, point);
  }
  const m4 converged = newton(c, c.exponent, problem, tolerance, point);
  if (all(converged)) return converged;
  Strength other;
  start_at(clipped_trial(c, 4.0, problem), problem, other);
  for (double n = 4.0; n < c.exponent; n *= 2.0) {
    evaluate(c, n, problem, other);
    newton(c, n, problem, max(tolerance, 1e-3 * size), other);
  }
  evaluate(c, c.exponent, problem, other);
  newton(c, c.exponent, problem, tolerance, other);
  point.unknowns = select(converged, point.unknowns, other.unknowns);
  evaluate(c, c.exponent, problem, point);
  return point.norm <= tolerance;
}

}  // namespace polyslip::material::simd
