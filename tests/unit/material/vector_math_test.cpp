#include "material/vector_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace {

using namespace polyslip::material;

TEST(VectorMath, PowerIsAccurateTo1e14WhereSlipFlows) {
  polyslip::core::Random random(1, polyslip::core::Stream::tests);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double n = random.uniform(1.0, 100.0), x = std::exp(random.uniform(-40.0, 30.0) / n);
    const auto got = simd::exp(n * simd::log(simd::broadcast(x)));
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(n));
    worst = std::max(worst, std::abs(static_cast<double>((got[i % 4] - exact) / exact)));
  }
  EXPECT_LT(worst, 1e-14);
  EXPECT_GT(worst, 0.0);
}

TEST(VectorMath, LogarithmAndExponentialOverTheWholeRange) {
  double worst_log = 0, worst_exp = 0;
  for (int i = -6900; i <= 6900; ++i) {
    const double y = 0.1 * i, x = std::exp(y);
    worst_exp = std::max(worst_exp, std::abs(simd::exp(simd::broadcast(y))[0] / x - 1));
    const double exact = std::log(x);
    if (i != 0) {
      worst_log = std::max(worst_log, std::abs(simd::log(simd::broadcast(x))[1] / exact - 1));
    }
  }
  EXPECT_LT(worst_log, 5e-16);
  EXPECT_LT(worst_exp, 5e-16);
  EXPECT_EQ(simd::log(simd::broadcast(1.0))[2], 0.0);
  EXPECT_EQ(simd::exp(simd::broadcast(-691.0))[3], 0.0);
  EXPECT_EQ(simd::exp(simd::broadcast(1e9))[0], simd::exp(simd::broadcast(690.0))[0]);
}

TEST(VectorMath, SelectionAndSigns) {
  const simd::v4 a = {-1.0, 2.0, -0.0, std::nan("")};
  EXPECT_EQ(simd::abs(a)[0], 1.0);
  EXPECT_EQ(simd::copysign(simd::broadcast(3.0), a)[2], -3.0);
  EXPECT_FALSE(simd::finite(a)[3]);
  EXPECT_TRUE(simd::any(simd::finite(a)));
  EXPECT_FALSE(simd::all(simd::finite(a)));
}

}  // namespace
