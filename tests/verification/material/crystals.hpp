#pragma once
// Orientations by plane and direction, materials for one purpose, and slip of a single crystal.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "material/crystal_law.hpp"
#include "material/point_driver.hpp"

namespace polyslip::material::test {

/// {plane}<direction>: the plane's normal along z (ND), the direction along x (RD).
inline core::Quaternion ideal_orientation(const core::Vec3& plane, const core::Vec3& direction) {
  const core::Vec3 z = plane.normalized(), x = direction.normalized();
  core::Mat3 sample_in_crystal;  // columns: RD, TD, ND in crystal axes
  sample_in_crystal << x, z.cross(x), z;
  return core::from_matrix(sample_in_crystal.transpose());
}

/// Rotation with the crystal direction `axis` along z.
inline core::Quaternion with_axis_along_z(const core::Vec3& axis) {
  const core::Vec3 other =
      axis.cross(std::abs(axis[0]) < 0.5 * axis.norm() ? core::Vec3::UnitX() : core::Vec3::UnitY());
  return ideal_orientation(axis, other);
}

/// A single crystal in plane strain: closed forms in the rate-independent limit.
struct Ideal {
  std::string name;
  core::Vec3 plane, direction;
  double limit;      // sum|gamma|/|eps33| as m -> 0
  double tolerance;  // of the limit: half its last printed digit, and 2e-4 for m = 0.02
  double at_012;     // the same at m = 0.12; 0: not known
};

inline std::vector<Ideal> ideals() {
  const double root6 = std::sqrt(6.0);
  return {{"cube", {0, 0, 1}, {1, 0, 0}, root6, 2e-4, 2.4571},
          {"Goss", {0, 1, 1}, {1, 0, 0}, root6, 2e-4, 0},
          {"brass", {0, 1, 1}, {2, 1, -1}, 4 * root6 / 3, 2e-4, 3.2739},
          {"copper", {1, 1, 2}, {1, 1, -1}, 1.5 * root6, 2e-4, 3.6831},
          {"S", {1, 2, 3}, {6, 3, -4}, 3.486, 7e-4, 0},
          {"D", {4, 4, 11}, {11, 11, -8}, 3.530, 7e-4, 3.5367},
          {"rotated", {0, 1, 1}, {0, 1, -1}, 2 * root6, 2e-4, 0}};
}

/// So stiff that elasticity is over after a strain of 1e-7, and without hardening.
inline MaterialOptions rigid_ideal(double m) {
  MaterialOptions o;
  o.c11 *= 1e5;
  o.c12 *= 1e5;
  o.c44 *= 1e5;
  o.g0 = o.gs = 1.0;
  o.h0 = 0;
  o.rate_sensitivity = m;
  return o;
}

inline core::Mat3 plane_strain() { return core::Vec3(1, 0, -1).asDiagonal(); }
inline core::Mat3 tension_z() { return core::Vec3(-0.5, -0.5, 1).asDiagonal(); }

struct SteadyFlow {
  double slip = 0;                         ///< sum|gamma| per unit of |L33| t
  core::Vec3 spin = core::Vec3::Zero();    ///< lattice spin per unit of |L33| t, sample frame
  core::Vec6 stress = core::Vec6::Zero();  ///< per g
  int failed = 0;
};

/// Flow at a frozen orientation: one step through the elastic range, then a step of 1e-5.
inline SteadyFlow steady_flow(double m, const core::Quaternion& q, const core::Mat3& rate) {
  const double dt = 1e-5;
  const auto law = make_fcc_law(rigid_ideal(m));
  PointDriver driver(*law, std::array{q});
  SteadyFlow flow;
  flow.failed += driver.advance(rate, dt);
  const double before = driver.state(0, law->layout().offset("slip"));
  const core::Quaternion old = driver.orientation(0);
  flow.failed += driver.advance(rate, dt);
  flow.slip = (driver.state(0, law->layout().offset("slip")) - before) / dt;
  flow.spin = 2 * (driver.orientation(0) * old.conjugate()).vec() / dt;
  flow.stress = driver.stress(0);
  return flow;
}

}  // namespace polyslip::material::test
