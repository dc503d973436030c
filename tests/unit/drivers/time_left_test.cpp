#include "drivers/time_left.hpp"

#include <gtest/gtest.h>

namespace polyslip::drivers {
namespace {

solver::LoadingOptions doubling() {
  solver::LoadingOptions loading;
  loading.initial_strain_increment = 0.01;
  loading.max_strain_increment = 0.04;
  loading.increment_growth = 2;
  return loading;
}

TEST(TimeLeft, CountsStepsThatGrow) {
  // 0.01, 0.02, then ten of 0.04
  EXPECT_NEAR(steps_over(0.43, 0.01, doubling()), 12, 1e-9);
  EXPECT_NEAR(steps_over(0.43, 0.04, doubling()), 0.43 / 0.04, 1e-9);
  EXPECT_NEAR(steps_over(0.005, 0.01, doubling()), 0.5, 1e-9);
  EXPECT_EQ(steps_over(0, 0.01, doubling()), 0);
  solver::LoadingOptions fixed = doubling();
  fixed.fixed_increment = true;
  EXPECT_NEAR(steps_over(0.4, 0.01, fixed), 10, 1e-9);
}

TEST(TimeLeft, StartsSmallAgainAfterEachScheduledRemeshingAhead) {
  const auto events = schedule({0.3}, {0.2, 0.43}, 0.1, 0.86);
  EXPECT_NEAR(steps_ahead(0, 0.01, 0.86, events, doubling()),
              steps_over(0.2, 0.01, doubling()) + steps_over(0.23, 0.01, doubling()) + 12, 1e-9);
  EXPECT_NEAR(steps_ahead(0.43, 0.01, 0.86, events, doubling()), 12, 1e-9);
  EXPECT_NEAR(steps_ahead(0.78, 0.04, 0.86, events, doubling()), 2, 1e-9);
}

TEST(TimeLeft, PaceForgetsSlowFirstSteps) {
  Pace pace;
  pace.add(100);
  EXPECT_EQ(pace.mean(), 100);
  pace.add(50);
  EXPECT_EQ(pace.mean(), 75);
  for (int i = 0; i < 60; ++i) pace.add(10);
  EXPECT_NEAR(pace.mean(), 10, 0.1);
}

}  // namespace
}  // namespace polyslip::drivers
