#pragma once
// The consistent tangent of the stress (docs/theory-material.md, (M.16) to (M.18)). Private to
// material.

#include "material/kinematics.hpp"
#include "material/slip_solver.hpp"

namespace polyslip::material::simd {

/// What update() knows of a block after the state has been found.
template <class Strength>
struct SolvedBlock {
  StepKinematics kinematics;  ///< crystal frame of n
  Mat3v trial_rotation;       ///< R_n r: crystal frame of n, rotated by the step, to sample
  Mat3v slip_rotation;        ///< exp(-hat(w))
  Problem<Strength> problem;
  Strength point;
  Vec5v stress;  ///< s, lattice frame [MPa]
};

/// dstress/dh, (M.16) to (M.18), entry 9 i + 3 k + l at tangent + lanes (9 i + 3 k + l).
template <class Strength>
inline void write_tangent(const SlipConstants& c, const SolvedBlock<Strength>& block, m4 valid,
                          double* tangent) {
  const SlipJacobian derivative = jacobian(c, c.exponent, block.problem, block.point);
  const Factors factors = factorise(derivative.rows);
  const StepKinematicsDerivative kinematics = step_kinematics_derivative(block.kinematics);
  const Mat3v& e = block.slip_rotation;
  const Mat3v turned = conjugate(e, to_matrix(block.stress));  // rotated frame of n
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -block.point.slips.spin[k];
  const Mat3v exp_rate = exp_derivative(minus_w);
  Vec5v turn[3];  // of the stress in the rotated frame of n by its lattice spin
  for (int k = 0; k < 3; ++k) turn[k] = commutator(unit3(k), turned);

  // rows[i][p][q]: d stress_i / d H_pq, both in the rotated crystal frame of n
  Mat3v rows[5] = {};
  const auto add = [](Mat3v& sum, v4 factor, const Mat3v& term) {
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q < 3; ++q) sum[p][q] += factor * term[p][q];
    }
  };
  for (int j = 0; j < 5; ++j) {
    Vec5v load = commutator(block.point.slips.spin, to_matrix(unit5(j)));
    for (int i = 0; i < 5; ++i) load[i] *= 0.5;
    load[j] += 1.0;
    const Vec5v dx = solve(factors, load);
    const v4 dscale = dot(derivative.strength, dx);
    Vec5v ds;
    for (int i = 0; i < 5; ++i)
      ds[i] = block.point.scale() * dx[i] + block.point.reduced(i) * dscale;
    const Vec5v ds_turned = to_deviator(conjugate(e, to_matrix(ds)));
    Vec3v dw, rotation;
    for (int k = 0; k < 3; ++k) {
      dw[k] = broadcast(0.0);
      for (int i = 0; i < 5; ++i) dw[k] += derivative.spin[i][k] * dx[i];
    }
    for (int k = 0; k < 3; ++k) {
      rotation[k] = exp_rate[k][0] * dw[0] + exp_rate[k][1] * dw[1] + exp_rate[k][2] * dw[2];
    }
    for (int i = 0; i < 5; ++i) {
      v4 entry = ds_turned[i];
      for (int k = 0; k < 3; ++k) entry -= turn[k][i] * rotation[k];
      add(rows[i], entry, kinematics.strain[j]);
    }
  }
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 3; ++k) add(rows[i], turn[k][i], kinematics.spin[k]);
  }

  const Mat3v& r = block.trial_rotation;
  Mat3v basis[5];
  for (int j = 0; j < 5; ++j) {
    rows[j] = conjugate(r, rows[j]);
    basis[j] = conjugate(r, to_matrix(unit5(j)));
  }
  constexpr int first[6] = {0, 1, 2, 1, 2, 0}, second[6] = {0, 1, 2, 2, 0, 1};
  for (int i = 0; i < 6; ++i) {
    const double mandel = i < 3 ? 1.0 : sqrt_two;
    for (int kl = 0; kl < 9; ++kl) {
      v4 entry = broadcast(0.0);
      for (int j = 0; j < 5; ++j) {
        entry += mandel * basis[j][first[i]][second[i]] * rows[j][kl / 3][kl % 3];
      }
      store(tangent + lanes * (9 * i + kl), select(valid, entry, broadcast(0.0)));
    }
  }
}

}  // namespace polyslip::material::simd
