#include "results/distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/error.hpp"

namespace polyslip::results {
namespace {

TEST(Distribution, OfOneToAHundredAndOne) {
  std::vector<double> values(101);
  std::iota(values.rbegin(), values.rend(), 1.0);
  const Distribution d = describe(values);
  EXPECT_EQ(d.count, 101);
  EXPECT_EQ(d.undefined, 0);
  EXPECT_DOUBLE_EQ(d.mean, 51);
  EXPECT_DOUBLE_EQ(d.deviation, std::sqrt((101.0 * 101 - 1) / 12));
  EXPECT_EQ(d.min, 1);
  EXPECT_EQ(d.max, 101);
  for (const int rank : percentile_ranks) EXPECT_DOUBLE_EQ(d.percentile(rank), 1 + rank);
  EXPECT_THROW(d.percentile(42), core::InternalError);
}

TEST(Distribution, PercentilesLieBetweenValues) {
  const Distribution d = describe(std::vector<float>{1, 2});
  EXPECT_DOUBLE_EQ(d.percentile(50), 1.5);
  EXPECT_NEAR(d.percentile(10), 1.1, 1e-12);
}

TEST(Distribution, CountsWhatIsNoNumber) {
  const Distribution d =
      describe(std::vector<double>{3, std::nan(""), 5, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(d.count, 2);
  EXPECT_EQ(d.undefined, 2);
  EXPECT_EQ(d.mean, 4);
}

TEST(Distribution, OfNothingIsNoNumber) {
  const Distribution d = describe(std::vector<double>{});
  EXPECT_EQ(d.count, 0);
  EXPECT_TRUE(std::isnan(d.mean));
  EXPECT_TRUE(std::isnan(d.deviation));
  EXPECT_TRUE(std::isnan(d.percentile(50)));
}

TEST(Histogram, CountsEachValueOnce) {
  Histogram h(0, 2, 4);
  for (const double v : {-0.1, 0.0, 0.49, 0.5, 1.99, 2.0, 2.01, std::nan("")}) h.add(v);
  EXPECT_EQ(h.counts, (std::vector<long>{2, 1, 0, 2}));
  EXPECT_EQ(h.below, 1);
  EXPECT_EQ(h.above, 1);
  EXPECT_EQ(h.total(), 7);
  EXPECT_DOUBLE_EQ(h.density()[0], 2 / (7 * 0.5));
  EXPECT_DOUBLE_EQ(h.cumulative().front(), 1.0 / 7);
  EXPECT_DOUBLE_EQ(h.cumulative().back(), 6.0 / 7);
  EXPECT_DOUBLE_EQ(h.centre(3), 1.75);
}

TEST(Histogram, RefusesBinsWithoutWidth) {
  EXPECT_THROW(Histogram(1, 1, 4), core::InternalError);
  EXPECT_THROW(Histogram(0, 1, 0), core::InternalError);
  EXPECT_THROW(Histogram(0, std::nan(""), 3), core::InternalError);
}

}  // namespace
}  // namespace polyslip::results
