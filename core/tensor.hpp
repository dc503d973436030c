#pragma once
// Second-order tensors as vectors, such that the dot product of two vectors is A : B.
//
// Mandel, Vec6:  (xx, yy, zz, sqrt2 yz, sqrt2 zx, sqrt2 xy).
//
// Deviators, Vec5, components along the orthonormal basis (b_i : b_j = delta_ij)
//   b_0 = (ex ex - ey ey) / sqrt 2
//   b_1 = (2 ez ez - ex ex - ey ey) / sqrt 6
//   b_2 = (ey ez + ez ey) / sqrt 2
//   b_3 = (ez ex + ex ez) / sqrt 2
//   b_4 = (ex ey + ey ex) / sqrt 2
// so that b_2, b_3, b_4 are Mandel's last three. Under cubic elasticity b_0 and b_1 have modulus
// C11 - C12, b_2 to b_4 have 2 C44.

#include <cmath>
#include <numbers>

#include "core/types.hpp"

namespace polyslip::core {

inline constexpr double sqrt2 = std::numbers::sqrt2;
inline constexpr double inv_sqrt2 = 1 / std::numbers::sqrt2;
inline constexpr double inv_sqrt3 = std::numbers::inv_sqrt3;
inline constexpr double inv_sqrt6 = inv_sqrt2 * inv_sqrt3;

using Mat5 = Eigen::Matrix<double, 5, 5>;
using Mat65 = Eigen::Matrix<double, 6, 5>;

inline Mat3 symmetric_part(const Mat3& a) { return 0.5 * (a + a.transpose()); }
inline Mat3 skew_part(const Mat3& a) { return 0.5 * (a - a.transpose()); }
inline Mat3 deviator(const Mat3& a) { return a - a.trace() / 3 * Mat3::Identity(); }

/// Mandel vector of the symmetric part of `a`.
inline Vec6 mandel(const Mat3& a) {
  Vec6 v;
  v << a(0, 0), a(1, 1), a(2, 2), inv_sqrt2 * (a(1, 2) + a(2, 1)), inv_sqrt2 * (a(2, 0) + a(0, 2)),
      inv_sqrt2 * (a(0, 1) + a(1, 0));
  return v;
}

inline Mat3 from_mandel(const Vec6& v) {
  const double yz = inv_sqrt2 * v[3], zx = inv_sqrt2 * v[4], xy = inv_sqrt2 * v[5];
  Mat3 a;
  a << v[0], xy, zx, xy, v[1], yz, zx, yz, v[2];
  return a;
}

/// Components of the symmetric deviatoric part of `a`.
inline Vec5 deviator5(const Mat3& a) {
  Vec5 v;
  v << inv_sqrt2 * (a(0, 0) - a(1, 1)), inv_sqrt6 * (2 * a(2, 2) - a(0, 0) - a(1, 1)),
      inv_sqrt2 * (a(1, 2) + a(2, 1)), inv_sqrt2 * (a(2, 0) + a(0, 2)),
      inv_sqrt2 * (a(0, 1) + a(1, 0));
  return v;
}

inline Mat3 from_deviator5(const Vec5& v) {
  const double p = inv_sqrt2 * v[0], q = inv_sqrt6 * v[1];
  const double yz = inv_sqrt2 * v[2], zx = inv_sqrt2 * v[3], xy = inv_sqrt2 * v[4];
  Mat3 a;
  a << p - q, xy, zx, xy, -p - q, yz, zx, yz, 2 * q;
  return a;
}

/// Mandel vector of a deviator given by its five components, and back (the trace is dropped).
inline Vec6 mandel_of_deviator5(const Vec5& v) {
  const double p = inv_sqrt2 * v[0], q = inv_sqrt6 * v[1];
  Vec6 m;
  m << p - q, -p - q, 2 * q, v[2], v[3], v[4];
  return m;
}

inline Vec5 deviator5_of_mandel(const Vec6& m) {
  Vec5 v;
  v << inv_sqrt2 * (m[0] - m[1]), inv_sqrt6 * (2 * m[2] - m[0] - m[1]), m[3], m[4], m[5];
  return v;
}

/// [5][5] orthogonal matrix M with deviator5(Q a Q^T) = M deviator5(a).
inline Mat5 deviator5_rotation(const Mat3& q) {
  Mat5 m;
  for (int i = 0; i < 5; ++i)
    m.col(i) = deviator5(q * from_deviator5(Vec5::Unit(i)) * q.transpose());
  return m;
}

/// W with W x = v cross x.
inline Mat3 skew(const Vec3& v) {
  Mat3 w;
  w << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return w;
}

/// The vector of the skew part of `w`: axial(skew(v)) = v.
inline Vec3 axial(const Mat3& w) {
  return 0.5 * Vec3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1));
}

/// sqrt(2/3 d:d), the von Mises equivalent of a strain-like deviator.
inline double equivalent_strain(const Mat3& d) { return std::sqrt(2.0 / 3.0) * deviator(d).norm(); }

/// sqrt(3/2 s:s) of the deviator s of a stress.
inline double equivalent_stress(const Mat3& s) { return std::sqrt(1.5) * deviator(s).norm(); }

}  // namespace polyslip::core
