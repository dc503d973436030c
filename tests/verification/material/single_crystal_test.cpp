// Single crystals against their closed forms in the rate-independent limit (Schmid factors, Taylor
// factors of ideal orientations), which hold to four digits at small m, and numbers at m = 0.12.

#include <gtest/gtest.h>

#include <cmath>

#include "crystals.hpp"

namespace {

using namespace polyslip;
using material::test::ideal_orientation;
using material::test::steady_flow;
using material::test::with_axis_along_z;

const double root6 = std::sqrt(6.0);

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

TEST(PlaneStrain, SlipOfIdealOrientations) {
  for (const auto& ideal : material::test::ideals()) {
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
