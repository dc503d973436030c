#include "material/slip_systems.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/rotation.hpp"

namespace {

using namespace polyslip;

TEST(SlipSystems, FccHasTwelveOnFourPlanesWithThreeDirectionsEach) {
  const auto systems = material::fcc_slip_systems();
  ASSERT_EQ(systems.size(), 12U);
  for (const auto& system : systems) {
    EXPECT_NEAR(system.normal.norm(), 1.0, 1e-15);
    EXPECT_NEAR(system.direction.norm(), 1.0, 1e-15);
    EXPECT_NEAR(system.normal.dot(system.direction), 0.0, 1e-15);
    EXPECT_NEAR(system.normal.cwiseAbs().minCoeff(), std::sqrt(1.0 / 3), 1e-15);
    EXPECT_NEAR(system.direction.cwiseAbs().maxCoeff(), std::sqrt(0.5), 1e-15);
    int same_plane = 0;
    for (const auto& other : systems) {
      same_plane += std::abs(std::abs(other.normal.dot(system.normal)) - 1) < 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(same_plane, 3);
  }
}

TEST(SlipSystems, BccSeedGivesItsOwnTwelve) {
  const auto systems =
      material::slip_systems({core::Vec3(0, 1, -1), core::Vec3(1, 1, 1)}, core::cubic_symmetries());
  EXPECT_EQ(systems.size(), 12U);
  EXPECT_EQ(
      material::slip_systems({core::Vec3(1, 1, 2), core::Vec3(1, 1, -1)}, core::cubic_symmetries())
          .size(),
      12U);
}

}  // namespace
