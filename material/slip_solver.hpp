#pragma once
// The implicit equations of slip at a point (docs/theory-material.md, (M.8) to (M.11), (M.15)):
// residual and Jacobian, and Newton's method with a monotone line search. Private to material.

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

/// Everything that the residual makes on its way, at the reduced stress of the point. With
/// x = s/g as unknown the slips do not need g, so Voce's g follows from them in closed form.
struct SlipPoint {
  Vec5v reduced;           ///< x = s/g, s = C' e
  v4 slip[systems];        ///< Dg_a
  v4 compliance[systems];  ///< dDg_a/d(P_a : x)
  v4 g;                    ///< end-of-step g [MPa]
  v4 total;                ///< Gamma = sum |Dg_a|
  Vec5v plastic;           ///< p = sum Dg_a P_a
  Vec3v spin;              ///< w = sum Dg_a q_a
  Vec5v residual;          ///< e - e_n - De_c - M w + p
  v4 norm;                 ///< |residual|
};

/// Derivatives with respect to x.
struct SlipJacobian {
  Vec3v spin[5];   ///< columns of dw/dx
  Vec5v strength;  ///< dg/dx [MPa]
  Vec5v rows[5];   ///< dresidual/dx
};

/// (M.9), end-of-step g of Voce's law for a given Gamma: g = (g_n + k Gamma gs)/(1 + k Gamma),
/// written so that rounding never lowers g.
inline v4 voce_strength(const SlipConstants& c, v4 g_old, v4 total) {
  const v4 y = c.voce * total;
  return g_old + (c.gs - g_old) * (y / (1.0 + y));
}
/// dg/dGamma of voce_strength.
inline v4 voce_strength_derivative(const SlipConstants& c, v4 g_old, v4 total) {
  const v4 y = 1.0 + c.voce * total;
  return c.voce * (c.gs - g_old) / (y * y);
}

/// P_a : x of every system.
inline void resolve(const SlipConstants& c, const Vec5v& x, v4* ratio) {
  for (std::size_t a = 0; a < systems; ++a) {
    ratio[a] = x[0] * c.schmid[a][0];
    for (int i = 1; i < 5; ++i) ratio[a] += x[i] * c.schmid[a][static_cast<std::size_t>(i)];
  }
}

/// The residual at point.reduced: (M.8) to (M.11).
inline void evaluate(const SlipConstants& c, double n, const SlipProblem& problem,
                     SlipPoint& point) {
  v4 ratio[systems];
  resolve(c, point.reduced, ratio);
  v4 total = broadcast(0.0);
  for (int i = 0; i < 5; ++i) point.plastic[i] = broadcast(0.0);
  for (int k = 0; k < 3; ++k) point.spin[k] = broadcast(0.0);
  for (std::size_t a = 0; a < systems; ++a) {
    const v4 size = max(abs(ratio[a]), broadcast(1e-300));
    // |tau/g|^(n-1), bounded so that no later product overflows
    const v4 power = problem.dt_rate * exp(min((n - 1.0) * log(size), broadcast(200.0)));
    point.compliance[a] = n * power;
    point.slip[a] = power * ratio[a];
  }
  for (std::size_t a = 0; a < systems; ++a) {
    total += abs(point.slip[a]);
    for (int i = 0; i < 5; ++i) {
      point.plastic[i] += point.slip[a] * c.schmid[a][static_cast<std::size_t>(i)];
    }
    for (int k = 0; k < 3; ++k) {
      point.spin[k] += point.slip[a] * c.spin[a][static_cast<std::size_t>(k)];
    }
  }
  point.total = total;
  point.g = voce_strength(c, problem.g_old, total);
  for (int i = 0; i < 5; ++i) {
    const double elastic_compliance = 1.0 / c.moduli[static_cast<std::size_t>(i)];
    point.residual[i] = point.g * point.reduced[i] * elastic_compliance - problem.elastic_old[i] -
                        problem.strain[i] + point.plastic[i];
    for (int k = 0; k < 3; ++k) point.residual[i] -= problem.turn[k][i] * point.spin[k];
  }
  point.norm = sqrt(dot(point.residual, point.residual));
}

/// The twin of evaluate, (M.15): dDg_a = compliance_a P_a . dx, dw/dx = sum compliance_a q_a P_a,
/// dg/dx = g' sum |.|'_a P_a,
/// dresidual/dx = g C'^-1 + (C'^-1 x) (dg/dx) + sum compliance_a P_a P_a - M dw/dx.
/// Symmetric positive definite but for terms of the order of the strain increments.
inline SlipJacobian jacobian(const SlipConstants& c, const SlipProblem& problem,
                             const SlipPoint& point) {
  SlipJacobian result = {};
  for (std::size_t a = 0; a < systems; ++a) {
    Vec5v scaled;
    const v4 sign = copysign(broadcast(1.0), point.slip[a]);
    for (int i = 0; i < 5; ++i) {
      scaled[i] = point.compliance[a] * c.schmid[a][static_cast<std::size_t>(i)];
      result.strength[i] += sign * scaled[i];
    }
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i <= j; ++i) {
        result.rows[i][j] += scaled[j] * c.schmid[a][static_cast<std::size_t>(i)];
      }
      for (int k = 0; k < 3; ++k) {
        result.spin[j][k] += scaled[j] * c.spin[a][static_cast<std::size_t>(k)];
      }
    }
  }
  const v4 hardening = voce_strength_derivative(c, problem.g_old, point.total);
  for (int i = 0; i < 5; ++i) {
    result.strength[i] *= hardening;
    for (int j = 0; j < i; ++j) result.rows[i][j] = result.rows[j][i];
  }
  for (int i = 0; i < 5; ++i) {
    const double elastic_compliance = 1.0 / c.moduli[static_cast<std::size_t>(i)];
    const v4 elastic = point.reduced[i] * elastic_compliance;
    for (int j = 0; j < 5; ++j) {
      result.rows[i][j] += elastic * result.strength[j];
      for (int k = 0; k < 3; ++k) result.rows[i][j] -= problem.turn[k][i] * result.spin[j][k];
    }
    result.rows[i][i] += point.g * elastic_compliance;
  }
  return result;
}

/// LU factors without pivoting, for the matrix of jacobian().
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

/// The elastic trial stress over g_n, drawn back along itself to where the incremental potential
/// s.C'^-1 s/2 - s.e_trial + sum Dg_a tau_a/(n + 1) is least on that ray, at g = g_n. The last term
/// is homogeneous in s, so one evaluation of the powers is enough.
inline Vec5v clipped_trial(const SlipConstants& c, double n, const SlipProblem& problem) {
  Vec5v trial, x;
  for (int i = 0; i < 5; ++i) {
    trial[i] = problem.elastic_old[i] + problem.strain[i];
    x[i] = trial[i] * c.moduli[static_cast<std::size_t>(i)] / problem.g_old;
  }
  v4 ratio[systems];
  resolve(c, x, ratio);
  v4 largest = broadcast(1e-200);
  for (const v4& r : ratio) largest = max(largest, abs(r));
  v4 work = broadcast(0.0);  // sum Dg_a tau_a/g where the largest |tau_a|/g is 1
  for (const v4& r : ratio) {
    work += exp((n + 1.0) * log(max(abs(r) / largest, broadcast(1e-300))));
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
inline m4 newton(const SlipConstants& c, double n, const SlipProblem& problem, v4 tolerance,
                 SlipPoint& point) {
  m4 open = ~(point.norm <= tolerance);
  for (int evaluation = 0; evaluation < max_evaluations && any(open);) {
    const Vec5v step = solve(factorise(jacobian(c, problem, point).rows), point.residual);
    const Vec5v start = point.reduced;
    const v4 norm = point.norm;
    v4 factor = select(open, broadcast(1.0), broadcast(0.0));
    m4 search = open;
    while (any(search) && evaluation < max_evaluations) {
      for (int i = 0; i < 5; ++i) {
        point.reduced[i] = select(open, start[i] - factor * step[i], start[i]);
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

/// Solves a step. The start is the old stress, or the clipped trial stress where the old one leaves
/// more than half the strain increment as residual and the trial less than it. Should a lane fail,
/// the whole block is solved again by continuation in the exponent (4, 8, 16, ... n), which only
/// lanes that failed take over. Tolerance on |residual|: relative_tolerance g_n/max(C') plus what
/// rounding leaves of the strains and powers.
inline m4 solve_slip(const SlipConstants& c, const SlipProblem& problem, SlipPoint& point) {
  double stiffest = c.moduli[0];
  for (const double modulus : c.moduli) stiffest = modulus > stiffest ? modulus : stiffest;
  const v4 increment = sqrt(dot(problem.strain, problem.strain));
  const v4 size = increment + sqrt(dot(problem.elastic_old, problem.elastic_old));
  const v4 tolerance =
      problem.g_old * (relative_tolerance / stiffest) + size * (8 * 2.2e-16 * c.exponent);
  for (int i = 0; i < 5; ++i) {
    point.reduced[i] =
        problem.elastic_old[i] * c.moduli[static_cast<std::size_t>(i)] / problem.g_old;
  }
  evaluate(c, c.exponent, problem, point);
  const m4 far = ~(point.norm <= 0.5 * increment);
  if (any(far)) {
    SlipPoint other;
    other.reduced = clipped_trial(c, c.exponent, problem);
    evaluate(c, c.exponent, problem, other);
    const m4 better = far & (other.norm < point.norm);
    for (int i = 0; i < 5; ++i) {
      point.reduced[i] = select(better, other.reduced[i], point.reduced[i]);
    }
    evaluate(c, c.exponent, problem, point);
  }
  const m4 converged = newton(c, c.exponent, problem, tolerance, point);
  if (all(converged)) return converged;
  SlipPoint other;
  other.reduced = clipped_trial(c, 4.0, problem);
  for (double n = 4.0; n < c.exponent; n *= 2.0) {
    evaluate(c, n, problem, other);
    newton(c, n, problem, max(tolerance, 1e-3 * size), other);
  }
  evaluate(c, c.exponent, problem, other);
  newton(c, c.exponent, problem, tolerance, other);
  for (int i = 0; i < 5; ++i) {
    point.reduced[i] = select(converged, point.reduced[i], other.reduced[i]);
  }
  evaluate(c, c.exponent, problem, point);
  return point.norm <= tolerance;
}

}  // namespace polyslip::material::simd
