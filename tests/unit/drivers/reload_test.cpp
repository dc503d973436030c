#include "drivers/reload.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace polyslip::drivers {
namespace {

TEST(VonMises, OfTensionAndShear) {
  EXPECT_NEAR(von_mises({0, 0, 30, 0, 0, 0}), 30, 1e-12);
  EXPECT_NEAR(von_mises({7, 7, 7, 0, 0, 2}), 2 * std::sqrt(3.0), 1e-12);
}

TEST(ReloadTracker, InterpolatesWithinTheStep) {
  ReloadTracker tracker;
  EXPECT_FALSE(tracker.step(0.1, 100).strain);  // nothing to follow
  tracker.start(0.3, 20 / 0.99, 0);
  EXPECT_FALSE(tracker.step(0.301, 10).strain);
  const auto result = tracker.step(0.303, 30);
  ASSERT_TRUE(result.strain);
  EXPECT_NEAR(*result.strain, 0.002, 1e-12);
  EXPECT_FALSE(result.ratio);
  EXPECT_FALSE(tracker.step(0.304, 30).strain);  // told once
}

TEST(ReloadTracker, ComparesWithTheCurveContinued) {
  ReloadTracker tracker;
  tracker.start(0.3, 20, 100);
  EXPECT_FALSE(tracker.step(0.3099, 20.9).ratio);
  const auto result = tracker.step(0.312, 21);
  ASSERT_TRUE(result.ratio);
  EXPECT_NEAR(*result.ratio, 21 / 21.2, 1e-12);
  EXPECT_FALSE(tracker.step(0.32, 22).ratio);  // told once
}

}  // namespace
}  // namespace polyslip::drivers
