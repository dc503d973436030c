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
  EXPECT_FALSE(tracker.step(0.1, 100));  // nothing to follow
  tracker.start(0.3, 20 / 0.99);
  EXPECT_FALSE(tracker.step(0.301, 10));
  const auto strain = tracker.step(0.303, 30);
  ASSERT_TRUE(strain);
  EXPECT_NEAR(*strain, 0.002, 1e-12);
  EXPECT_FALSE(tracker.step(0.304, 30));  // told once
}

}  // namespace
}  // namespace polyslip::drivers
