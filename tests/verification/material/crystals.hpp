#pragma once
// Orientations by plane and direction, materials for one purpose, and slip of a single crystal.

#include <array>
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
