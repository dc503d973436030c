#include "core/lognormal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"

namespace {

using polyslip::core::Lognormal;

TEST(Normal, QuantilesInvertTheDistribution) {
  EXPECT_NEAR(polyslip::core::normal_quantile(0.5), 0, 1e-15);
  EXPECT_NEAR(polyslip::core::normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(polyslip::core::normal_quantile(1e-12), -7.034483824, 1e-6);
  for (const double p : {1e-9, 0.01, 0.3, 0.5, 0.8, 0.999})
    EXPECT_NEAR(polyslip::core::normal_cdf(polyslip::core::normal_quantile(p)), p, 1e-14);
  EXPECT_THROW(polyslip::core::normal_quantile(0), polyslip::core::InternalError);
  EXPECT_THROW(polyslip::core::normal_quantile(1), polyslip::core::InternalError);
}

TEST(Lognormal, HasTheAskedMoments) {
  const Lognormal d(2.0, 0.7);
  EXPECT_NEAR(d.moment(1), 2.0, 1e-14);
  EXPECT_NEAR(d.moment(2) - 4.0, 0.49, 1e-13);
  EXPECT_NEAR(d.cdf(d.quantile(0.2)), 0.2, 1e-14);
  EXPECT_EQ(d.cdf(0), 0);
  EXPECT_EQ(d.density(-1), 0);
  const double h = 1e-5;
  EXPECT_NEAR(d.density(1.7), (d.cdf(1.7 + h) - d.cdf(1.7 - h)) / (2 * h), 1e-8);
  EXPECT_THROW(Lognormal(1, 0), polyslip::core::InputError);
  EXPECT_THROW(Lognormal(-1, 1), polyslip::core::InputError);
}

TEST(KolmogorovSmirnov, IsTheLargestDifference) {
  const auto uniform = [](double x) { return x; };
  EXPECT_NEAR(polyslip::core::kolmogorov_smirnov({0.5}, uniform), 0.5, 1e-15);
  EXPECT_NEAR(polyslip::core::kolmogorov_smirnov({0.75, 0.25}, uniform), 0.25, 1e-15);
  EXPECT_NEAR(polyslip::core::kolmogorov_smirnov({0.1, 0.2, 0.3}, uniform), 0.7, 1e-15);
  EXPECT_TRUE(std::isnan(polyslip::core::kolmogorov_smirnov({0.1, std::nan("")}, uniform)));
  EXPECT_THROW(polyslip::core::kolmogorov_smirnov({}, uniform), polyslip::core::InternalError);
}

}  // namespace
