#pragma once
// The implicit equations of slip at a point (theory page, "Equations of a step"): residual and
// Jacobian, and Newton's method with a monotone line search. Private to material.

#include <array>

#include "material/vector_tensor.hpp"

namespace polyslip::material::simd {

inline constexpr int systems = 12;

/// Constants of the crystal, the same at every point.
struct SlipConstants {
  std::array<std::array<double, 5>, systems> schmid;  ///< P_a, symmetric Schmid tensors
  std::array<std::array<double, 3>, systems> spin;    ///< q_a, axial vectors of the skew ones
  std::array<double, 5> moduli;                       ///< C' [MPa]
  double exponent;                                    ///< n = 1/m
  double reference_rate;                              ///< gammadot0 [1/s]
  double voce;  ///< k = h0/(gs - g0) [1]; zero without hardening
  double gs;    ///< MPa
};

/// What is given at a point for one step, crystal frame.
struct SlipProblem {
  Vec5v elastic_old;  ///< e_n
  Vec5v strain;       ///< De_c, deviatoric strain increment in the lattice frame of n
  Vec5v turn[3];      ///< columns of M: (hat(u_k) De_c - De_c hat(u_k))/2
  v4 g_old;           ///< g_n [MPa]
  double dt_rate;     ///< dt gammadot0 [1]
};

/// Everything that the residual makes on its way, at the stress of the point.
struct SlipPoint {
  Vec5v stress;            ///< s = C' e [MPa]
  v4 slip[systems];        ///< Dg_a
  v4 compliance[systems];  ///< dDg_a/dtau_a at fixed g [1/MPa]
  v4 g;                    ///< end-of-step g [MPa]
  v4 total;                ///< Gamma = sum |Dg_a|
  Vec5v plastic;           ///< p = sum Dg_a P_a
  Vec3v spin;              ///< w = sum Dg_a q_a
  Vec5v residual;          ///< e - e_n - De_c - M w + p
  v4 norm;                 ///< |residual|
};

/// The derivatives of slip with respect to the stress, and the Jacobian dresidual/ds [5x5].
struct SlipJacobian {
  Vec5v spin[3];  ///< rows of dw/ds
  Vec5v rows[5];
};

/// End-of-step g of Voce's law for a given Gamma: g = (g_n + k Gamma gs)/(1 + k Gamma), written so
/// that rounding never lowers g.
inline v4 voce_strength(const SlipConstants& c, v4 g_old, v4 total) {
  const v4 x = c.voce * total;
  return g_old + (c.gs - g_old) * (x / (1.0 + x));
}
/// dg/dGamma of voce_strength.
inline v4 voce_strength_derivative(const SlipConstants& c, v4 g_old, v4 total) {
  const v4 x = 1.0 + c.voce * total;
  return c.voce * (c.gs - g_old) / (x * x);
}

/// ln of the factor that takes slips computed with the strength g_trial to those with the strength
/// that they cause: y = ln Gamma solves y + n ln g(exp y) = ln Gamma_trial + n ln g_trial. The left
/// side grows with slope 1 or more; Newton's method kept inside a shrinking bracket.
inline v4 hardening_shift(const SlipConstants& c, double n, v4 g_old, v4 total_trial, v4 g_trial) {
  const v4 start = log(max(total_trial, broadcast(1e-280)));
  const v4 target = start + n * log(g_trial);
  const v4 gs = broadcast(c.gs);
  v4 low = target - n * log(max(gs, g_old));
  v4 high = target - n * log(min(gs, g_old));
  v4 y = min(max(start, low), high);
  m4 open = total_trial * c.voce > 1e-18;
  for (int iteration = 0; iteration < 80 && any(open); ++iteration) {
    const v4 total = exp(y);
    const v4 g = voce_strength(c, g_old, total);
    const v4 excess = y + n * log(g) - target;
    low = select(excess < 0.0, y, low);
    high = select(excess > 0.0, y, high);
    v4 next = y - excess / (1.0 + n * total * voce_strength_derivative(c, g_old, total) / g);
    next = select((next < low) | (next > high), 0.5 * (low + high), next);
    const v4 change = abs(next - y);
    y = select(open, next, y);
    open = open & (change > 1e-8);
  }
  return y - start;
}

/// The residual at point.stress; point.g holds a first guess of the strength and gets the new one.
inline void evaluate(const SlipConstants& c, double n, const SlipProblem& problem,
                     SlipPoint& point) {
  const v4 inverse_g = 1.0 / point.g;
  v4 total = broadcast(0.0);
  for (int a = 0; a < systems; ++a) {
    const auto& schmid = c.schmid[static_cast<std::size_t>(a)];
    v4 ratio = point.stress[0] * schmid[0];
    for (int i = 1; i < 5; ++i) ratio += point.stress[i] * schmid[static_cast<std::size_t>(i)];
    ratio *= inverse_g;
    const v4 size = max(abs(ratio), broadcast(1e-300));
    // |tau/g|^(n-1), bounded so that no later product overflows
    const v4 power = exp(min((n - 1.0) * log(size), broadcast(200.0)));
    point.compliance[a] = (n * problem.dt_rate) * power * inverse_g;
    point.slip[a] = problem.dt_rate * power * ratio;
    total += abs(point.slip[a]);
  }
  if (c.voce > 0) {
    const v4 factor = exp(hardening_shift(c, n, problem.g_old, total, point.g));
    total *= factor;
    for (int a = 0; a < systems; ++a) {
      point.slip[a] *= factor;
      point.compliance[a] *= factor;
    }
  }
  point.total = total;
  point.g = voce_strength(c, problem.g_old, total);
  for (int i = 0; i < 5; ++i) point.plastic[i] = broadcast(0.0);
  for (int k = 0; k < 3; ++k) point.spin[k] = broadcast(0.0);
  for (int a = 0; a < systems; ++a) {
    const auto system = static_cast<std::size_t>(a);
    for (int i = 0; i < 5; ++i) {
      point.plastic[i] += point.slip[a] * c.schmid[system][static_cast<std::size_t>(i)];
    }
    for (int k = 0; k < 3; ++k) {
      point.spin[k] += point.slip[a] * c.spin[system][static_cast<std::size_t>(k)];
    }
  }
  for (int i = 0; i < 5; ++i) {
    point.residual[i] = point.stress[i] * (1.0 / c.moduli[static_cast<std::size_t>(i)]) -
                        problem.elastic_old[i] - problem.strain[i] + point.plastic[i];
    for (int k = 0; k < 3; ++k) point.residual[i] -= problem.turn[k][i] * point.spin[k];
  }
  point.norm = sqrt(dot(point.residual, point.residual));
}

/// The twin of evaluate: dDg_a = compliance_a dtau_a - Dg_a beta t . ds with t = dGamma/ds at fixed
/// g and beta = (n g'/g)/(1 + n Gamma g'/g); then
/// dp/ds = sum compliance_a P_a P_a - beta p t, dw/ds = sum compliance_a q_a P_a - beta w t,
/// dresidual/ds = C'^-1 + dp/ds - M dw/ds.
inline SlipJacobian jacobian(const SlipConstants& c, double n, const SlipProblem& problem,
                             const SlipPoint& point) {
  SlipJacobian result = {};
  Vec5v t = {};
  for (int a = 0; a < systems; ++a) {
    const auto system = static_cast<std::size_t>(a);
    Vec5v scaled;
    for (int i = 0; i < 5; ++i) {
      scaled[i] = point.compliance[a] * c.schmid[system][static_cast<std::size_t>(i)];
      t[i] += copysign(broadcast(1.0), point.slip[a]) * scaled[i];
    }
    for (int i = 0; i < 5; ++i) {
      for (int j = i; j < 5; ++j) {
        result.rows[i][j] += scaled[j] * c.schmid[system][static_cast<std::size_t>(i)];
      }
    }
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 5; ++j) {
        result.spin[k][j] += scaled[j] * c.spin[system][static_cast<std::size_t>(k)];
      }
    }
  }
  const v4 slope = n * voce_strength_derivative(c, problem.g_old, point.total) / point.g;
  const v4 beta = slope / (1.0 + point.total * slope);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < i; ++j) result.rows[i][j] = result.rows[j][i];
  }
  for (int j = 0; j < 5; ++j) {
    for (int k = 0; k < 3; ++k) result.spin[k][j] -= beta * point.spin[k] * t[j];
    for (int i = 0; i < 5; ++i) {
      result.rows[i][j] -= beta * point.plastic[i] * t[j];
      for (int k = 0; k < 3; ++k) result.rows[i][j] -= problem.turn[k][i] * result.spin[k][j];
    }
    result.rows[j][j] += 1.0 / c.moduli[static_cast<std::size_t>(j)];
  }
  return result;
}

/// LU factors without pivoting: the matrix is symmetric positive definite but for terms of the
/// order of the strain increment.
struct Factors {
  v4 a[5][5];  ///< unit lower and upper triangle
  v4 inverse_pivot[5];
};

inline Factors factorise(const Vec5v* rows) {
  Factors f;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) f.a[i][j] = rows[i][j];
  }
  for (int k = 0; k < 5; ++k) {
    f.inverse_pivot[k] = 1.0 / f.a[k][k];
    for (int i = k + 1; i < 5; ++i) {
      f.a[i][k] *= f.inverse_pivot[k];
      for (int j = k + 1; j < 5; ++j) f.a[i][j] -= f.a[i][k] * f.a[k][j];
    }
  }
  return f;
}

inline Vec5v solve(const Factors& f, Vec5v x) {
  for (int i = 1; i < 5; ++i) {
    for (int j = 0; j < i; ++j) x[i] -= f.a[i][j] * x[j];
  }
  for (int i = 4; i >= 0; --i) {
    for (int j = i + 1; j < 5; ++j) x[i] -= f.a[i][j] * x[j];
    x[i] *= f.inverse_pivot[i];
  }
  return x;
}

/// The elastic trial stress drawn back along itself to where the incremental potential
/// s.C'^-1 s/2 - s.e_trial + sum Dg_a tau_a/(n + 1) is least on that ray, at g = g_n. The last term
/// is homogeneous in s, so one evaluation of the powers is enough.
inline Vec5v clipped_trial(const SlipConstants& c, double n, const SlipProblem& problem) {
  Vec5v trial, stress;
  for (int i = 0; i < 5; ++i) {
    trial[i] = problem.elastic_old[i] + problem.strain[i];
    stress[i] = trial[i] * c.moduli[static_cast<std::size_t>(i)];
  }
  v4 ratio[systems];
  v4 largest = broadcast(1e-200);
  for (int a = 0; a < systems; ++a) {
    const auto& schmid = c.schmid[static_cast<std::size_t>(a)];
    ratio[a] = stress[0] * schmid[0];
    for (int i = 1; i < 5; ++i) ratio[a] += stress[i] * schmid[static_cast<std::size_t>(i)];
    ratio[a] = abs(ratio[a]) / problem.g_old;
    largest = max(largest, ratio[a]);
  }
  v4 work = broadcast(0.0);  // sum Dg_a tau_a where the largest |tau_a|/g is 1
  for (int a = 0; a < systems; ++a) {
    work += exp((n + 1.0) * log(max(ratio[a] / largest, broadcast(1e-300))));
  }
  work *= problem.dt_rate * problem.g_old;
  // With s = mu s_trial/largest: elastic mu + work mu^n = elastic largest; y = ln mu
  const v4 elastic = max(dot(trial, stress) / (largest * largest), broadcast(1e-200));
  const v4 load = elastic * largest;
  const v4 limit = log(largest);
  v4 y = min(limit, log(max(load / max(work, broadcast(1e-200)), broadcast(1e-200))) * (1.0 / n));
  for (int iteration = 0; iteration < 3; ++iteration) {
    const v4 linear = elastic * exp(y), power = work * exp(n * y);
    y -= (linear + power - load) / (linear + n * power);
  }
  const v4 factor = exp(min(y - limit, broadcast(0.0)));
  for (int i = 0; i < 5; ++i) stress[i] *= factor;
  return stress;
}

inline constexpr double relative_tolerance = 1e-12;
inline constexpr int max_evaluations = 200;  ///< of the residual in one Newton solve

/// Evaluates at `start` and lets it replace `point` in the lanes where its residual is smaller.
inline void offer(const SlipConstants& c, double n, const SlipProblem& problem, const Vec5v& start,
                  SlipPoint& point) {
  SlipPoint other;
  other.stress = start;
  other.g = problem.g_old;
  evaluate(c, n, problem, other);
  const m4 better = other.norm < point.norm;
  for (int i = 0; i < 5; ++i) point.stress[i] = select(better, other.stress[i], point.stress[i]);
  point.g = select(better, other.g, point.g);
  point.norm = select(better, other.norm, point.norm);
}

/// Newton's method for residual = 0 from point.stress, point.g with backtracking until |residual|
/// falls: Armijo's rule with the fraction 1e-4, step factors from the parabola through value, slope
/// and the rejected value, kept in [0.1, 0.5]. A lane that has reached `tolerance` or cannot fall
/// any more stands still: later evaluations repeat its last one bit for bit, so that no lane
/// depends on its neighbours. On return `point` is evaluated; the lanes that converged are
/// returned.
inline m4 newton(const SlipConstants& c, double n, const SlipProblem& problem, v4 tolerance,
                 SlipPoint& point) {
  v4 guess = point.g;
  evaluate(c, n, problem, point);
  m4 open = ~(point.norm <= tolerance);
  for (int evaluation = 0; evaluation < max_evaluations && any(open);) {
    Vec5v step = solve(factorise(jacobian(c, n, problem, point).rows), point.residual);
    for (int i = 0; i < 5; ++i) step[i] = select(open, -step[i], broadcast(0.0));
    const Vec5v start = point.stress;
    const v4 norm = point.norm;
    guess = select(open, point.g, guess);
    v4 factor = broadcast(1.0);
    m4 search = open;
    while (any(search) && evaluation < max_evaluations) {
      for (int i = 0; i < 5; ++i) point.stress[i] = start[i] + factor * step[i];
      point.g = guess;
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

/// Solves a step. The start is the old stress or the clipped trial stress, whichever leaves the
/// smaller residual. Should a lane fail, the whole block is solved again by continuation in the
/// exponent (4, 8, 16, ... n), which only lanes that failed take over. Tolerance on |residual|:
/// relative_tolerance g_n/max(C') plus what rounding leaves of the strains and powers.
inline m4 solve_slip(const SlipConstants& c, const SlipProblem& problem, SlipPoint& point) {
  double stiffest = c.moduli[0];
  for (const double modulus : c.moduli) stiffest = modulus > stiffest ? modulus : stiffest;
  const v4 size = sqrt(dot(problem.strain, problem.strain)) +
                  sqrt(dot(problem.elastic_old, problem.elastic_old));
  const v4 tolerance =
      problem.g_old * (relative_tolerance / stiffest) + size * (8 * 2.2e-16 * c.exponent);
  for (int i = 0; i < 5; ++i) {
    point.stress[i] = problem.elastic_old[i] * c.moduli[static_cast<std::size_t>(i)];
  }
  point.g = problem.g_old;
  evaluate(c, c.exponent, problem, point);
  offer(c, c.exponent, problem, clipped_trial(c, c.exponent, problem), point);
  const m4 converged = newton(c, c.exponent, problem, tolerance, point);
  if (all(converged)) return converged;
  SlipPoint other;
  other.stress = clipped_trial(c, 4.0, problem);
  other.g = problem.g_old;
  for (double n = 4.0; n < c.exponent; n *= 2.0) {
    newton(c, n, problem, max(tolerance, 1e-3 * size), other);
  }
  newton(c, c.exponent, problem, tolerance, other);
  for (int i = 0; i < 5; ++i) {
    point.stress[i] = select(converged, point.stress[i], other.stress[i]);
  }
  point.g = select(converged, point.g, other.g);
  return newton(c, c.exponent, problem, tolerance, point);
}

}  // namespace polyslip::material::simd
