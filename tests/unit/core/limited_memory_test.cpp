#include "core/limited_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using Eigen::VectorXd;
using polyslip::core::ValueAndGradient;

// Rosenbrock's valley; least, 0, at (1, 1).
ValueAndGradient rosenbrock(const VectorXd& x) {
  const double a = 1 - x[0], b = x[1] - x[0] * x[0];
  VectorXd gradient(2);
  gradient << -2 * a - 400 * x[0] * b, 200 * b;
  return {a * a + 100 * b * b, gradient};
}

TEST(LimitedMemory, FollowsRosenbrocksValley) {
  VectorXd start(2), taken(2), tried(2);
  start << -1.2, 1;
  int points = 0;
  const VectorXd end = polyslip::core::minimise(
      start,
      [&](const VectorXd& x) {
        tried = x;
        return rosenbrock(x);
      },
      [&] {
        taken = tried;
        ++points;
      },
      [](int) { return false; }, {.max_iterations = 200, .largest_step = 1});
  EXPECT_NEAR(end[0], 1, 1e-6);
  EXPECT_NEAR(end[1], 1, 1e-6);
  EXPECT_EQ(taken, end);
  EXPECT_GT(points, 5);
  EXPECT_LT(points, 120);
}

TEST(LimitedMemory, StaysWhereTheFunctionExists) {
  VectorXd start(2);
  start << 0.2, 0.2;
  const auto outside = [](const VectorXd& x) { return x[0] > 0.6; };
  const VectorXd end = polyslip::core::minimise(
      start,
      [&](const VectorXd& x) -> std::optional<ValueAndGradient> {
        if (outside(x)) return std::nullopt;
        return rosenbrock(x);
      },
      [] {}, [](int) { return false; }, {});
  EXPECT_FALSE(outside(end));
  EXPECT_LT(rosenbrock(end).value, rosenbrock(start).value);
}

TEST(LimitedMemory, StopsWhenAsked) {
  VectorXd start(2);
  start << -1.2, 1;
  int last = -1;
  polyslip::core::minimise(
      start, rosenbrock, [] {},
      [&](int iteration) {
        last = iteration;
        return iteration == 3;
      },
      {});
  EXPECT_EQ(last, 3);
}

}  // namespace
