#pragma once
// Small tensors, four points at a time. Private to material, as vector_math.hpp.
//
// 5-vectors are symmetric deviatoric tensors in the basis of core/tensor.hpp, which diagonalises
// cubic elasticity in crystal axes.

#include "material/vector_math.hpp"

namespace polyslip::material::simd {

template <int n>
struct Vec {
  v4 a[n];
  v4& operator[](int i) { return a[i]; }
  const v4& operator[](int i) const { return a[i]; }
};
using Vec3v = Vec<3>;
using Vec5v = Vec<5>;

struct Mat3v {
  v4 a[3][3];
  v4* operator[](int i) { return a[i]; }
  const v4* operator[](int i) const { return a[i]; }
};

inline constexpr double sqrt_half = 0.70710678118654752440;
inline constexpr double sqrt_sixth = 0.40824829046386301637;
inline constexpr double sqrt_two = 1.41421356237309504880;

template <int n>
inline v4 dot(const Vec<n>& a, const Vec<n>& b) {
  v4 sum = a[0] * b[0];
  for (int i = 1; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

inline Mat3v mul(const Mat3v& a, const Mat3v& b) {
  Mat3v c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  }
  return c;
}

inline Mat3v transpose(const Mat3v& a) {
  Mat3v c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c[i][j] = a[j][i];
  }
  return c;
}

/// a b a^T
inline Mat3v conjugate(const Mat3v& a, const Mat3v& b) { return mul(a, mul(b, transpose(a))); }

inline Mat3v cofactor(const Mat3v& a) {
  Mat3v c;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  }
  return c;
}

inline v4 determinant(const Mat3v& a) {
  const Mat3v c = cofactor(a);
  return a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
}

/// a^-T
inline Mat3v inverse_transpose(const Mat3v& a) {
  Mat3v c = cofactor(a);
  const v4 scale = 1.0 / (a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2]);
  for (auto& row : c.a) {
    for (auto& entry : row) entry *= scale;
  }
  return c;
}

/// Skew tensor of an axial vector: hat(w) v = w x v.
inline Mat3v hat(const Vec3v& w) {
  const v4 zero = broadcast(0.0);
  return {{{zero, -w[2], w[1]}, {w[2], zero, -w[0]}, {-w[1], w[0], zero}}};
}

inline Mat3v to_matrix(const Vec5v& s) {
  const v4 s1 = s[1] * sqrt_sixth, s0 = s[0] * sqrt_half;
  const v4 yz = s[2] * sqrt_half, zx = s[3] * sqrt_half, xy = s[4] * sqrt_half;
  return {{{s0 - s1, xy, zx}, {xy, -s0 - s1, yz}, {zx, yz, 2.0 * s1}}};
}

/// Components of the deviatoric symmetric part of m.
inline Vec5v to_deviator(const Mat3v& m) {
  return {(m[0][0] - m[1][1]) * sqrt_half, (2.0 * m[2][2] - m[0][0] - m[1][1]) * sqrt_sixth,
          (m[1][2] + m[2][1]) * sqrt_half, (m[2][0] + m[0][2]) * sqrt_half,
          (m[0][1] + m[1][0]) * sqrt_half};
}

/// hat(w) d - d hat(w) for a symmetric deviatoric d given as matrix.
inline Vec5v commutator(const Vec3v& w, const Mat3v& d) {
  Mat3v x = mul(hat(w), d);  // the commutator is x + x^T: twice its symmetric part
  for (auto& row : x.a) {
    for (auto& entry : row) entry *= 2.0;
  }
  return to_deviator(x);
}

inline Vec3v unit3(int k) {
  Vec3v v = {broadcast(0.0), broadcast(0.0), broadcast(0.0)};
  v[k] = broadcast(1.0);
  return v;
}

inline Vec5v unit5(int k) {
  Vec5v v = {broadcast(0.0), broadcast(0.0), broadcast(0.0), broadcast(0.0), broadcast(0.0)};
  v[k] = broadcast(1.0);
  return v;
}

/// Quaternion w x y z.
using Quaternionv = Vec<4>;

inline Quaternionv mul(const Quaternionv& p, const Quaternionv& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// Rotation matrix of q, whatever the norm of q.
inline Mat3v to_matrix(const Quaternionv& q) {
  const v4 s = 2.0 / dot(q, q);
  const v4 xx = s * q[1] * q[1], yy = s * q[2] * q[2], zz = s * q[3] * q[3];
  const v4 xy = s * q[1] * q[2], yz = s * q[2] * q[3], zx = s * q[3] * q[1];
  const v4 wx = s * q[0] * q[1], wy = s * q[0] * q[2], wz = s * q[0] * q[3];
  return {{{1.0 - yy - zz, xy - wz, zx + wy},
           {xy + wz, 1.0 - zz - xx, yz - wx},
           {zx - wy, yz + wx, 1.0 - xx - yy}}};
}

/// Unit quaternion of a rotation matrix: of the four columns of 4 q q^T, the one with the largest
/// diagonal (each lane takes its own).
inline Quaternionv to_quaternion(const Mat3v& r) {
  const v4 wx = r[2][1] - r[1][2], wy = r[0][2] - r[2][0], wz = r[1][0] - r[0][1];
  const v4 xy = r[1][0] + r[0][1], yz = r[2][1] + r[1][2], zx = r[0][2] + r[2][0];
  const Quaternionv columns[4] = {{1.0 + r[0][0] + r[1][1] + r[2][2], wx, wy, wz},
                                  {wx, 1.0 + r[0][0] - r[1][1] - r[2][2], xy, zx},
                                  {wy, xy, 1.0 - r[0][0] + r[1][1] - r[2][2], yz},
                                  {wz, zx, yz, 1.0 - r[0][0] - r[1][1] + r[2][2]}};
  Quaternionv best = columns[0];
  v4 diagonal = columns[0][0];
  for (int k = 1; k < 4; ++k) {
    const m4 larger = columns[k][k] > diagonal;
    diagonal = select(larger, columns[k][k], diagonal);
    for (int i = 0; i < 4; ++i) best[i] = select(larger, columns[k][i], best[i]);
  }
  const v4 scale = 1.0 / sqrt(dot(best, best));
  for (int i = 0; i < 4; ++i) best[i] *= scale;
  return best;
}

/// Unit quaternion of the rotation by the vector w: Taylor series for w/8, squared three times.
inline Quaternionv exp_quaternion(const Vec3v& w) {
  const v4 x = dot(w, w) * (1.0 / 256);  // (|w|/16)^2, half the angle of w/8
  v4 cosine = broadcast(1.0), sine = broadcast(1.0);
  for (int j = 7; j >= 1; --j) {
    cosine = 1.0 - cosine * x * (1.0 / ((2 * j - 1) * (2 * j)));
    sine = 1.0 - sine * x * (1.0 / ((2 * j) * (2 * j + 1)));
  }
  const v4 scale = sine * (1.0 / 16);
  Quaternionv q = {cosine, scale * w[0], scale * w[1], scale * w[2]};
  for (int doubling = 0; doubling < 3; ++doubling) q = mul(q, q);
  return q;
}

/// J(v) with d(exp hat(v)) exp(-hat(v)) = hat(J(v) dv):
/// J = 1 + (1 - cos t)/t^2 hat(v) + (t - sin t)/t^3 hat(v)^2, t = |v|; series, 1e-13 for t <= 2.
inline Mat3v exp_derivative(const Vec3v& v) {
  const v4 x = dot(v, v);
  v4 first = broadcast(1.0), second = broadcast(1.0);
  for (int j = 9; j >= 1; --j) {
    first = 1.0 - first * x * (1.0 / ((2 * j + 1) * (2 * j + 2)));
    second = 1.0 - second * x * (1.0 / ((2 * j + 2) * (2 * j + 3)));
  }
  const Mat3v skew = hat(v), square = mul(skew, skew);
  Mat3v result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result[i][j] = 0.5 * first * skew[i][j] + (1.0 / 6) * second * square[i][j];
    }
    result[i][i] += 1.0;
  }
  return result;
}

}  // namespace polyslip::material::simd
