#pragma once
// What the equations of slip at a point are made of (docs/theory-material.md, (M.8) to (M.11)),
// whether the systems share one slip strength or have one each. Private to material.

#include <array>

#include "material/vector_tensor.hpp"
#include "material/voce.hpp"

namespace polyslip::material::simd {

inline constexpr int systems = 12;

/// Constants of the crystal, the same at every point.
struct SlipConstants {
  std::array<std::array<double, 5>, systems> schmid;  ///< P_a, symmetric Schmid tensors
  std::array<std::array<double, 3>, systems> spin;    ///< q_a, axial vectors of the skew ones
  std::array<double, 5> moduli;                       ///< C' [MPa]
  double exponent;                                    ///< n = 1/m
  double reference_rate;                              ///< gammadot0 [1/s]
  VoceConstants voce;
  double latent;  ///< hardening of a system by another one over that by itself
};

/// What is given at a point for one step, crystal frame. `strengths` is 1 or `systems`.
template <int strengths>
struct SlipProblem {
  Vec5v elastic_old;    ///< e_n
  Vec5v strain;         ///< De_c, deviatoric strain increment in the lattice frame of n
  Vec5v turn[3];        ///< columns of M: (hat(u_k) De_c - De_c hat(u_k))/2
  v4 g_old[strengths];  ///< g_n [MPa]
  v4 mean_g_old;        ///< mean of g_n [MPa]
  double dt_rate;       ///< dt gammadot0 [1]

  /// g_n of system a over its mean.
  v4 ratio_old(int a) const {
    if constexpr (strengths == 1) return broadcast(1.0);
    return g_old[a] / mean_g_old;
  }
};

/// Slip increments and what they add up to.
struct Slips {
  v4 slip[systems];        ///< Dg_a
  v4 compliance[systems];  ///< dDg_a/d(tau_a/g_a)
  v4 total;                ///< Gamma = sum |Dg_a|
  Vec5v plastic;           ///< p = sum Dg_a P_a
  Vec3v spin;              ///< w = sum Dg_a q_a
};

/// Derivatives with respect to x of what the equations give once the strengths have followed.
struct SlipJacobian {
  Vec3v spin[5];   ///< columns of dw/dx
  Vec5v strength;  ///< d(s/x)/dx, the change of the factor between s and x [MPa]
  Vec5v rows[5];   ///< dresidual/dx
};

/// P_a : x of every system.
inline void resolve(const SlipConstants& c, const Vec5v& x, v4* ratio) {
  for (std::size_t a = 0; a < systems; ++a) {
    ratio[a] = x[0] * c.schmid[a][0];
    for (int i = 1; i < 5; ++i) ratio[a] += x[i] * c.schmid[a][static_cast<std::size_t>(i)];
  }
}

/// (M.8) and (M.10) of the ratios tau_a/g_a.
inline void slips_of(const SlipConstants& c, double n, double dt_rate, const v4* ratio, Slips& s) {
  for (int a = 0; a < systems; ++a) {
    const v4 size = max(abs(ratio[a]), broadcast(1e-300));
    // |tau/g|^(n-1), bounded so that no later product overflows
    const v4 power = dt_rate * exp(min((n - 1.0) * log(size), broadcast(200.0)));
    s.compliance[a] = n * power;
    s.slip[a] = power * ratio[a];
  }
  s.total = broadcast(0.0);
  for (int i = 0; i < 5; ++i) s.plastic[i] = broadcast(0.0);
  for (int k = 0; k < 3; ++k) s.spin[k] = broadcast(0.0);
  for (std::size_t a = 0; a < systems; ++a) {
    s.total += abs(s.slip[a]);
    for (int i = 0; i < 5; ++i) {
      s.plastic[i] += s.slip[a] * c.schmid[a][static_cast<std::size_t>(i)];
    }
    for (int k = 0; k < 3; ++k) {
      s.spin[k] += s.slip[a] * c.spin[a][static_cast<std::size_t>(k)];
    }
  }
}

/// (M.11): scale C'^-1 x - e_n - De_c - M w + p.
template <int strengths>
inline Vec5v strain_residual(const SlipConstants& c, const SlipProblem<strengths>& problem,
                             const Slips& s, v4 scale, const Vec5v& x) {
  Vec5v residual;
  for (int i = 0; i < 5; ++i) {
    const double elastic_compliance = 1.0 / c.moduli[static_cast<std::size_t>(i)];
    residual[i] = scale * x[i] * elastic_compliance - problem.elastic_old[i] - problem.strain[i] +
                  s.plastic[i];
    for (int k = 0; k < 3; ++k) residual[i] -= problem.turn[k][i] * s.spin[k];
  }
  return residual;
}

/// Of Dg_a = compliance_a P_a . x, signed as Dg_a: spin = sum compliance_a q_a P_a, strength = sum
/// sgn_a compliance_a P_a, rows = sum compliance_a P_a P_a.
inline SlipJacobian slip_derivatives(const SlipConstants& c, const v4* compliance, const v4* slip) {
  SlipJacobian result = {};
  for (std::size_t a = 0; a < systems; ++a) {
    Vec5v scaled;
    const v4 sign = copysign(broadcast(1.0), slip[a]);
    for (int i = 0; i < 5; ++i) {
      scaled[i] = compliance[a] * c.schmid[a][static_cast<std::size_t>(i)];
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
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < i; ++j) result.rows[i][j] = result.rows[j][i];
  }
  return result;
}

}  // namespace polyslip::material::simd
