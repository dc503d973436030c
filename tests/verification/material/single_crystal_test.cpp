// Single crystals against their closed forms in the rate-independent limit (Schmid factors, Taylor
// factors of ideal orientations), which hold to four digits at small m, and numbers at m = 0.12.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "crystals.hpp"

namespace {

using namespace polyslip;
using material::test::ideal_orientation;
using material::test::steady_flow;

const double root6 = std::sqrt(6.0);

/// Rotation with the crystal direction `axis` along z.
core::Quaternion with_axis_along_z(const core::Vec3& axis) {
  const core::Vec3 other =
      axis.cross(std::abs(axis[0]) < 0.5 * axis.norm() ? core::Vec3::UnitX() : core::Vec3::UnitY());
  return ideal_orientation(axis, other);
}

TEST(Tension, Axis001HasEightEqualSystemsAndNoSpin) {
  for (const double m : {0.05, 0.02, 0.12}) {
    const auto flow = steady_flow(m, with_axis_along_z({0, 0, 1}), material::test::tension_z());
    ASSERT_EQ(flow.failed, 0);
    // eight systems at 0.30619 = sqrt 6 / 8 each; axial stress = tau sqrt 6
    EXPECT_NEAR(flow.slip, root6, 1e-4);
    EXPECT_NEAR(flow.stress[2] - flow.stress[0], std::pow(root6 / 8, m) * root6, 1e-4);
    EXPECT_NEAR(flow.stress[2] - flow.stress[1], std::pow(root6 / 8, m) * root6, 1e-4);
    EXPECT_LT(flow.spin.norm(), 1e-8);
  }
}

TEST(Tension, Axis111HasSixEqualSystemsAndNoSpin) {
  for (const double m : {0.05, 0.02, 0.12}) {
    const auto flow = steady_flow(m, with_axis_along_z({1, 1, 1}), material::test::tension_z());
    ASSERT_EQ(flow.failed, 0);
    const double factor = 1.5 * root6;  // 3.6742 = 6 * 0.61237, 1/0.27217
    EXPECT_NEAR(flow.slip, factor, 1e-4);
    EXPECT_NEAR(flow.stress[2] - flow.stress[0], std::pow(factor / 6, m) * factor, 1e-4);
    EXPECT_LT(flow.spin.norm(), 1e-8);
  }
}

struct Ideal {
  std::string name;
  core::Vec3 plane, direction;
  double limit;      // sum|gamma|/|eps33| as m -> 0
  double tolerance;  // of the limit: half its last printed digit, and 2e-4 for m = 0.02
  double at_012;     // the same at m = 0.12; 0: not known
};

std::vector<Ideal> ideals() {
  return {{"cube", {0, 0, 1}, {1, 0, 0}, root6, 2e-4, 2.4571},
          {"Goss", {0, 1, 1}, {1, 0, 0}, root6, 2e-4, 0},
          {"brass", {0, 1, 1}, {2, 1, -1}, 4 * root6 / 3, 2e-4, 3.2739},
          {"copper", {1, 1, 2}, {1, 1, -1}, 1.5 * root6, 2e-4, 3.6831},
          {"S", {1, 2, 3}, {6, 3, -4}, 3.486, 7e-4, 0},
          {"D", {4, 4, 11}, {11, 11, -8}, 3.530, 7e-4, 3.5367},
          {"rotated", {0, 1, 1}, {0, 1, -1}, 2 * root6, 2e-4, 0}};
}

TEST(PlaneStrain, SlipOfIdealOrientations) {
  for (const auto& ideal : ideals()) {
    const auto q = ideal_orientation(ideal.plane, ideal.direction);
    const auto flow = steady_flow(0.02, q, material::test::plane_strain());
    ASSERT_EQ(flow.failed, 0) << ideal.name;
    EXPECT_NEAR(flow.slip, ideal.limit, ideal.tolerance) << ideal.name;
    if (ideal.at_012 == 0) continue;
    EXPECT_NEAR(steady_flow(0.12, q, material::test::plane_strain()).slip, ideal.at_012, 1e-4)
        << ideal.name;
  }
}

TEST(PlaneStrain, LatticeSpins) {
  const auto spin = [](const core::Vec3& plane, const core::Vec3& direction) {
    return steady_flow(0.02, ideal_orientation(plane, direction), material::test::plane_strain())
        .spin;
  };
  EXPECT_LT(spin({0, 0, 1}, {1, 0, 0}).norm(), 1e-8);
  EXPECT_LT(spin({0, 1, 1}, {1, 0, 0}).norm(), 1e-8);
  const core::Vec3 copper = spin({1, 1, 2}, {1, 1, -1});
  EXPECT_NEAR(std::abs(copper[1]), std::sqrt(2.0) / 3, 1e-3);
  EXPECT_LT(std::hypot(copper[0], copper[2]), 1e-8);
  const core::Vec3 dillamore = spin({4, 4, 11}, {11, 11, -8});
  EXPECT_NEAR(std::abs(dillamore[1]), 0.009, 1e-3);
  // copper turns towards D: the angle between them is 8 degrees about TD
  const auto from = ideal_orientation({1, 1, 2}, {1, 1, -1});
  const auto to = ideal_orientation({4, 4, 11}, {11, 11, -8});
  EXPECT_GT(copper[1] * (to * from.conjugate()).y() * (to * from.conjugate()).w(), 0.0);
}

}  // namespace
