#include "solver/predictor.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

TEST(Predictor, IsExactForAMotionQuadraticInStrain) {
  const auto u = [](double e) { return 3 * e - 7 * e * e; };
  Predictor predictor(1, 1);
  double at = 0.1;
  for (double h : {0.01, 0.016}) {
    predictor.record({u(at + h) - u(at)}, {2 * h}, h);
    at += h;
  }
  std::vector<double> x{5}, p{1};
  predictor.extrapolate(0.02, x, p);
  EXPECT_NEAR(x[0], 5 + u(at + 0.02) - u(at), 1e-14);
  EXPECT_NEAR(p[0], 1 + 2 * 0.02, 1e-14);
}

TEST(Predictor, StartsFromNothingAndThenFromOneStep) {
  Predictor predictor(1, 1);
  std::vector<double> x{5}, p{1};
  predictor.extrapolate(0.02, x, p);
  EXPECT_EQ(x[0], 5);
  EXPECT_EQ(p[0], 1);
  predictor.record({0.01}, {0.0}, 0.01);
  predictor.extrapolate(0.02, x, p);
  EXPECT_DOUBLE_EQ(x[0], 5.02);
}

TEST(Predictor, HistoryGoesRoundAndRubbishIsRefused) {
  Predictor a(2, 1), b(2, 1);
  a.record({1, 2}, {3}, 0.1);
  a.record({2, 1}, {4}, 0.2);
  b.restore(a.rate(), a.previous_rate(), a.pressure_rate(), a.steps()[0], a.steps()[1]);
  std::vector<double> xa{0, 0}, xb{0, 0}, pa{0}, pb{0};
  a.extrapolate(0.3, xa, pa);
  b.extrapolate(0.3, xb, pb);
  EXPECT_EQ(xa, xb);
  EXPECT_EQ(pa, pb);
  EXPECT_NE(xa[0], 0);
  EXPECT_THROW(b.restore({1}, {1, 2}, {3}, 0.1, 0.1), core::InternalError);
}

}  // namespace
}  // namespace polyslip::solver
