#include "core/rotation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"

namespace polyslip::core {

namespace {

// Variants whose cosines of the half angle differ by less than this are taken as equally far.
constexpr double tie = 1e-12;

std::array<Quaternion, 24> generate_cubic_symmetries() {
  std::array<Quaternion, 24> symmetries;
  std::size_t count = 0;
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 matrix = Mat3::Zero();
      for (int i = 0; i < 3; ++i) matrix(i, axes[i]) = (signs >> i & 1) != 0 ? -1 : 1;
      if (matrix.determinant() > 0) symmetries.at(count++) = from_matrix(matrix);
    }
  } while (std::ranges::next_permutation(axes).found);
  if (count != 24) throw InternalError("cubic symmetries: " + std::to_string(count) + ", not 24");
  return symmetries;
}

double degrees_0_360(double radians) {
  double d = radians * degrees_per_radian;
  if (d < 0) d += 360;
  return d >= 360 ? 0 : d;
}

}  // namespace

Quaternion canonical_sign(const Quaternion& q) {
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) {
    if (c > 0) return q;
    if (c < 0) return Quaternion(-q.coeffs());
  }
  return q;
}

Quaternion aligned_sign(const Quaternion& q, const Quaternion& reference) {
  return q.dot(reference) < 0 ? Quaternion(-q.coeffs()) : q;
}

Mat3 to_matrix(const Quaternion& q) { return q.toRotationMatrix(); }

Quaternion from_matrix(const Mat3& matrix) {
  return canonical_sign(Quaternion(matrix).normalized());
}

Vec3 to_rodrigues(const Quaternion& q) { return q.vec() / q.w(); }

Quaternion from_rodrigues(const Vec3& r) { return Quaternion(1, r[0], r[1], r[2]).normalized(); }

// From q = q_z(phi1) q_x(Phi) q_z(phi2):
//   w = cos(Phi/2) cos((phi1+phi2)/2),  z = cos(Phi/2) sin((phi1+phi2)/2),
//   x = sin(Phi/2) cos((phi1-phi2)/2),  y = sin(Phi/2) sin((phi1-phi2)/2).
Vec3 to_bunge(const Quaternion& q) {
  const double c = std::hypot(q.w(), q.z()), s = std::hypot(q.x(), q.y());
  const double Phi = 2 * std::atan2(s, c) * degrees_per_radian;
  if (s < 1e-14)
    return {degrees_0_360(std::remainder(2 * std::atan2(q.z(), q.w()), 2 * std::numbers::pi)), 0,
            0};
  if (c < 1e-14)
    return {degrees_0_360(std::remainder(2 * std::atan2(q.y(), q.x()), 2 * std::numbers::pi)), 180,
            0};
  const double half_sum = std::atan2(q.z(), q.w()), half_difference = std::atan2(q.y(), q.x());
  const double turn = 2 * std::numbers::pi;
  return {degrees_0_360(std::remainder(half_sum + half_difference, turn)), Phi,
          degrees_0_360(std::remainder(half_sum - half_difference, turn))};
}

Quaternion from_bunge(const Vec3& degrees) {
  const Vec3 a = degrees / (2 * degrees_per_radian);
  const double c = std::cos(a[1]), s = std::sin(a[1]);
  const double sum = a[0] + a[2], difference = a[0] - a[2];
  return canonical_sign(Quaternion(c * std::cos(sum), s * std::cos(difference),
                                   s * std::sin(difference), c * std::sin(sum))
                            .normalized());
}

Quaternion exp_axial(const Vec3& v) {
  const double angle = v.norm();
  // sin(t/2)/t; below 1e-4 its series, whose error is under 1e-20.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  return Quaternion(std::cos(angle / 2), factor * v[0], factor * v[1], factor * v[2]).normalized();
}

double rotation_angle(const Quaternion& q) {
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

const std::array<Quaternion, 24>& cubic_symmetries() {
  static const std::array<Quaternion, 24> symmetries = generate_cubic_symmetries();
  return symmetries;
}

Quaternion nearest_variant(const Quaternion& q, const Quaternion& reference) {
  Quaternion best = q;
  double best_cosine = -1;
  for (const auto& symmetry : cubic_symmetries()) {
    const Quaternion variant = q * symmetry;
    const double cosine = std::abs(variant.dot(reference));
    if (cosine > best_cosine + tie) {
      best_cosine = cosine;
      best = variant;
    }
  }
  return aligned_sign(best, reference);
}

double disorientation_angle(const Quaternion& a, const Quaternion& b) {
  return rotation_angle(nearest_variant(a.conjugate() * b, Quaternion::Identity()));
}

Quaternion fundamental_variant(const Quaternion& q) {
  return nearest_variant(q, Quaternion::Identity());
}

Vec3 fundamental_rodrigues(const Quaternion& q) { return to_rodrigues(fundamental_variant(q)); }

Vec3 paper_colour(const Quaternion& q) {
  constexpr double edge = std::numbers::sqrt2 - 1;
  const Vec3 colour = 255 * (fundamental_rodrigues(q) + Vec3::Constant(edge)) / (2 * edge);
  return colour.cwiseMax(0).cwiseMin(255);  // round-off on the region's surface
}

Quaternion mean_rotation(std::span<const Quaternion> rotations, std::span<const double> weights) {
  if (rotations.empty()) throw InternalError("mean_rotation: no rotations");
  if (!weights.empty() && weights.size() != rotations.size())
    throw InternalError("mean_rotation: " + std::to_string(weights.size()) + " weights for " +
                        std::to_string(rotations.size()) + " rotations");
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Vector4d c = rotations[i].coeffs();
    sum += (weights.empty() ? 1.0 : weights[i]) * c * c.transpose();
  }
  if (!sum.allFinite() || !(sum.trace() > 0))
    throw InternalError("mean_rotation: sum of weights is " + std::to_string(sum.trace()));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  return aligned_sign(Quaternion(Eigen::Vector4d(solver.eigenvectors().col(3))), rotations[0]);
}

Quaternion mean_orientation(std::span<const Quaternion> orientations, const Quaternion& reference,
                            std::span<const double> weights) {
  std::vector<Quaternion> variants;
  variants.reserve(orientations.size());
  for (const auto& q : orientations) variants.push_back(nearest_variant(q, reference));
  return mean_rotation(variants, weights);
}

}  // namespace polyslip::core
