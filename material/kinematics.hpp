#pragma once
// The strain increment and the rotation of a step, and their derivatives (docs/theory-material.md,
// (M.5), (M.6), (M.16)). Private to material.

#include "material/vector_tensor.hpp"

namespace polyslip::material::simd {

/// fbar = r u of a step, in the crystal frame of its start.
struct StepKinematics {
  Mat3v rotation;  ///< r
  Mat3v stretch;   ///< u, symmetric, det 1
  Vec5v strain;    ///< dev(ln u)
  m4 valid;        ///< lanes with finite f and det f > 0
};

/// Derivatives with respect to H, df f^-1 turned into the rotated crystal frame r:
/// d strain_i = strain[i] : H, d(r) = r hat(spin) with spin_i = spin[i] : H.
struct StepKinematicsDerivative {
  Mat3v strain[5];
  Mat3v spin[3];
};

inline constexpr int log_terms = 5;  // 2 (z + z^3/3 + ... + z^9/9): 1e-15 for |u - 1| <= 0.1

/// z = (u - 1)(u + 1)^-1 and (u + 1)^-1, all of which commute with u.
struct CayleyTransform {
  Mat3v z;
  Mat3v inverse;  ///< (u + 1)^-1
};

inline CayleyTransform cayley_transform(const Mat3v& u) {
  Mat3v plus = u;
  for (int i = 0; i < 3; ++i) plus[i][i] += 1.0;
  CayleyTransform result;
  result.inverse = inverse_transpose(plus);  // plus is symmetric
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.z[i][j] = (i == j ? 1.0 : 0.0) - 2.0 * result.inverse[i][j];
    }
  }
  return result;
}

/// Rotation of the polar decomposition by Newton's iteration r <- (r + r^-T)/2, which squares the
/// error: seven steps reach rounding for stretches between 0.4 and 2.5.
inline Mat3v polar_rotation(const Mat3v& f) {
  Mat3v r = f;
  for (int step = 0; step < 7; ++step) {
    const Mat3v s = inverse_transpose(r);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r[i][j] = 0.5 * (r[i][j] + s[i][j]);
    }
  }
  return r;
}

/// ln u = 2 artanh(z), truncated after log_terms terms.
inline Mat3v stretch_logarithm(const Mat3v& u) {
  const Mat3v z = cayley_transform(u).z, y = mul(z, z);
  Mat3v p = {};
  for (int i = 0; i < 3; ++i) p[i][i] = broadcast(1.0 / (2 * log_terms - 1));
  for (int k = log_terms - 2; k >= 0; --k) {
    p = mul(y, p);
    for (int i = 0; i < 3; ++i) p[i][i] += 1.0 / (2 * k + 1);
  }
  Mat3v logarithm = mul(z, p);
  for (auto& row : logarithm.a) {
    for (auto& entry : row) entry *= 2.0;
  }
  return logarithm;
}

/// The twin of stretch_logarithm: its derivative at u in the symmetric direction du. It is
/// self-adjoint.
inline Mat3v stretch_logarithm_derivative(const CayleyTransform& cayley, const Mat3v& du) {
  const Mat3v& z = cayley.z;
  const Mat3v y = mul(z, z);
  Mat3v dz = mul(cayley.inverse, mul(du, cayley.inverse));
  for (auto& row : dz.a) {
    for (auto& entry : row) entry *= 2.0;
  }
  const Mat3v dz_z = mul(dz, z);
  Mat3v dy, p = {}, dp = {};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) dy[i][j] = dz_z[i][j] + dz_z[j][i];
    p[i][i] = broadcast(1.0 / (2 * log_terms - 1));
  }
  for (int k = log_terms - 2; k >= 0; --k) {
    const Mat3v first = mul(dy, p), second = mul(y, dp);
    p = mul(y, p);
    for (int i = 0; i < 3; ++i) {
      p[i][i] += 1.0 / (2 * k + 1);
      for (int j = 0; j < 3; ++j) dp[i][j] = first[i][j] + second[i][j];
    }
  }
  const Mat3v first = mul(dz, p), second = mul(z, dp);
  Mat3v result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i][j] = 2.0 * (first[i][j] + second[i][j]);
  }
  return result;
}

/// f is the relative deformation gradient in the crystal frame of the start of the step.
inline StepKinematics step_kinematics(Mat3v f) {
  StepKinematics result;
  const v4 det = determinant(f);
  v4 sum = det;
  for (const auto& row : f.a) {
    for (const auto& entry : row) sum += abs(entry);
  }
  result.valid = finite(sum) & (det > 1e-30);
  const v4 scale = exp(log(select(result.valid, det, broadcast(1.0))) * (-1.0 / 3));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      f[i][j] = select(result.valid, f[i][j] * scale, broadcast(i == j ? 1.0 : 0.0));
    }
  }
  result.rotation = polar_rotation(f);
  const Mat3v u = mul(transpose(result.rotation), f);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.stretch[i][j] = 0.5 * (u[i][j] + u[j][i]);
  }
  result.strain = to_deviator(stretch_logarithm(result.stretch));
  return result;
}

/// a_i = -e_ijk x_jk, so that hat(v) : x = v . a
inline Vec3v dual(const Mat3v& x) {
  return {x[2][1] - x[1][2], x[0][2] - x[2][0], x[1][0] - x[0][1]};
}

inline StepKinematicsDerivative step_kinematics_derivative(const StepKinematics& kinematics) {
  const Mat3v& u = kinematics.stretch;
  const CayleyTransform cayley = cayley_transform(u);
  const v4 trace = u[0][0] + u[1][1] + u[2][2];
  Mat3v y;  // tr(u) 1 - u
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) y[i][j] = (i == j ? trace : broadcast(0.0)) - u[i][j];
  }
  y = inverse_transpose(y);
  StepKinematicsDerivative result;
  for (int k = 0; k < 3; ++k) result.spin[k] = mul(hat({y[k][0], y[k][1], y[k][2]}), u);
  for (int i = 0; i < 5; ++i) {
    const Mat3v g = stretch_logarithm_derivative(cayley, to_matrix(unit5(i)));
    result.strain[i] = mul(g, u);
    const Vec3v c = dual(result.strain[i]);
    for (int k = 0; k < 3; ++k) {
      for (int p = 0; p < 3; ++p) {
        for (int q = 0; q < 3; ++q) result.strain[i][p][q] -= c[k] * result.spin[k][p][q];
      }
    }
  }
  return result;
}

}  // namespace polyslip::material::simd
