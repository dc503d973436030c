#pragma once
// Stress and slip of a rate-sensitive FCC crystal under a diagonal stress (0, s_y, s_z), found
// without any of the program's material code: the power law is homogeneous, so one root gives all.

#include <array>
#include <cmath>

#include "core/types.hpp"

namespace polyslip::tests {

struct SlipState {
  core::Vec3 stress;     ///< over g
  core::Vec3 rate;       ///< diagonal of the strain rate over the magnitude of the zz one
  double slip_rate = 0;  ///< sum |gammadot| over the magnitude of the zz rate
};

/// Strain rate of the stress diag(s)/g, reference rate 1.
inline SlipState flow(const core::Mat3& crystal_axes, const core::Vec3& s, double m) {
  SlipState out;
  out.stress = s;
  out.rate.setZero();
  const int signs[4][3] = {{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}};
  for (const auto& n : signs)
    for (int i = 0; i < 3; ++i) {  // the direction has a zero at i and lies in the plane
      core::Vec3 b = core::Vec3::Zero();
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      b[j] = n[k];
      b[k] = -n[j];
      const core::Vec3 normal = crystal_axes * core::Vec3(n[0], n[1], n[2]) / std::sqrt(3.0);
      const core::Vec3 direction = crystal_axes * b / std::sqrt(2.0);
      const core::Vec3 schmid = normal.cwiseProduct(direction);
      const double tau = schmid.dot(s);
      const double rate = std::copysign(std::pow(std::abs(tau), 1 / m), tau);
      out.rate += rate * schmid;
      out.slip_rate += std::abs(rate);
    }
  return out;
}

/// Under |D_zz| = 1, of the sign of `sign`, with D_yy = 0 if `plane_strain` and s_y = 0 otherwise.
inline SlipState closed_form(const core::Mat3& crystal_axes, double m, double sign,
                             bool plane_strain) {
  double low = -1, high = 2;  // s_y for s_z = 1
  if (!plane_strain) low = high = 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (flow(crystal_axes, {0, middle, 1}, m).rate[1] > 0 ? high : low) = middle;
  }
  const SlipState unit = flow(crystal_axes, {0, high, 1}, m);
  const double scale = std::pow(1 / std::abs(unit.rate[2]), m);
  SlipState out = flow(crystal_axes, core::Vec3(0, high, 1) * scale * sign, m);
  return out;
}

}  // namespace polyslip::tests
