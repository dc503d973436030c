#include "solver/step_control.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

LoadingOptions options() {
  LoadingOptions o;
  o.initial_strain_increment = 2e-4;
  o.increment_growth = 1.6;
  o.max_strain_increment = 0.02;
  return o;
}

TEST(StepControl, GrowsToTheLargestAndHitsTargetsWithoutSlivers) {
  StepControl c(options());
  double strain = 0, smallest = 1, previous = 0;
  int steps = 0;
  for (double target : {0.1, 0.2, 0.3})
    while (strain < target) {
      const double end = c.next_end(strain, target);
      ASSERT_LE(end, target);
      const double taken = end - strain;
      ASSERT_LE(taken, 0.02 * (1 + 1e-9));
      if (steps > 0) {
        ASSERT_LE(taken, 1.6 * previous * 1.0001 + 0.01);
      }
      smallest = std::min(smallest, taken);
      previous = taken;
      c.accepted(taken);
      strain = end;
      ++steps;
    }
  EXPECT_EQ(strain, 0.3);
  EXPECT_DOUBLE_EQ(smallest, 2e-4);
  EXPECT_DOUBLE_EQ(c.size(), 0.02);
  EXPECT_GT(steps, 20);
  EXPECT_LT(steps, 30);
}

TEST(StepControl, ACutHalvesAndTheSizeGrowsBack) {
  StepControl c(options());
  for (int i = 0; i < 20; ++i) c.accepted(c.size());
  EXPECT_DOUBLE_EQ(c.size(), 0.02);
  EXPECT_TRUE(c.cut(0.02));
  EXPECT_DOUBLE_EQ(c.size(), 0.01);
  c.accepted(0.01);
  EXPECT_DOUBLE_EQ(c.size(), 0.016);
  while (c.cut(c.size())) EXPECT_GE(c.size(), 1e-7);
  EXPECT_LT(c.size(), 1e-7);
}

TEST(StepControl, FixedIncrementsStartAtTheLargest) {
  LoadingOptions o = options();
  o.fixed_increment = true;
  StepControl c(o);
  EXPECT_DOUBLE_EQ(c.next_end(0, 0.3), 0.02);
  EXPECT_DOUBLE_EQ(c.next_end(0.28, 0.3), 0.3);
}

TEST(StepControl, ARestartAfterAStopTakesNoStepBelowTheSmallest) {
  StepControl stopped(options()), again(options());
  while (stopped.cut(stopped.size())) {
  }
  ASSERT_LT(stopped.size(), options().min_strain_increment);
  again.restore(stopped.history());
  EXPECT_EQ(again.size(), options().min_strain_increment);
}

TEST(StepControl, HistoryGoesRoundAndRubbishIsRefused) {
  StepControl a(options()), b(options());
  a.accepted(a.size());
  b.restore(a.history());
  EXPECT_EQ(a.size(), b.size());
  EXPECT_THROW(b.restore({}), core::InternalError);
  EXPECT_THROW(b.restore({-1.0}), core::InternalError);
}

}  // namespace
}  // namespace polyslip::solver
