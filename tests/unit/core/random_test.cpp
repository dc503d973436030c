#include "core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/rotation.hpp"

namespace polyslip::core {
namespace {

// First outputs of splitmix64 from state 0, as published with the generator.
TEST(Random, SplitmixGivesItsPublishedNumbers) {
  std::uint64_t state = 0;
  EXPECT_EQ(splitmix64(state), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(splitmix64(state), 0x6e789e6aa1b965f4ULL);
  EXPECT_EQ(splitmix64(state), 0x06c45d188009454fULL);
}

TEST(Random, SameSeedAndStreamGiveTheSameNumbersOthersDoNot) {
  Random a(1, 2), b(1, 2), other_stream(1, 3), other_seed(2, 2);
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const auto x = a.bits();
    EXPECT_EQ(x, b.bits());
    equal += x == other_stream.bits();
    equal += x == other_seed.bits();
  }
  EXPECT_EQ(equal, 0);
}

TEST(Random, StaysTheSameFromVersionToVersion) {
  Random random(1, Stream::seeds);
  const auto first = random.bits();
  Random again(1, 1);
  EXPECT_EQ(first, again.bits());
  EXPECT_EQ(first, 7561176300338230394ULL);
}

TEST(Random, UniformHasTheMomentsOfTheUnitInterval) {
  Random random(7, Stream::tests);
  const int n = 200000;
  double sum = 0, squares = 0, previous = 0.5, products = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    squares += x * x;
    products += (x - 0.5) * (previous - 0.5);
    previous = x;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.003);
  EXPECT_NEAR(squares / n, 1.0 / 3, 0.003);
  EXPECT_NEAR(products / n, 0, 0.001);
}

TEST(Random, NormalHasZeroMeanUnitVarianceAndKurtosisThree) {
  Random random(7, Stream::tests);
  const int n = 200000;
  double m1 = 0, m2 = 0, m4 = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    m1 += x;
    m2 += x * x;
    m4 += x * x * x * x;
  }
  EXPECT_NEAR(m1 / n, 0, 0.01);
  EXPECT_NEAR(m2 / n, 1, 0.015);
  EXPECT_NEAR(m4 / n, 3, 0.1);
}

TEST(Random, IndexCoversItsRangeEvenly) {
  Random random(3, Stream::tests);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts.at(random.index(7));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
}

// Density of the angle t of a uniform rotation is (1 - cos t)/pi: mean pi/2 + 2/pi = 126.5 degrees.
// Every axis of the crystal is uniform on the sphere: second moments 1/3.
TEST(Random, RotationsAreUniform) {
  Random random(5, Stream::tests);
  const int n = 100000;
  double angle = 0;
  Mat3 moments = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    const Quaternion q = random.rotation();
    ASSERT_NEAR(q.norm(), 1, 1e-14);
    angle += rotation_angle(q);
    const Vec3 axis = q * Vec3(1, 2, 2) / 3;
    moments += axis * axis.transpose();
  }
  EXPECT_NEAR(angle / n, M_PI / 2 + 2 / M_PI, 0.01);
  EXPECT_LT((moments / n - Mat3::Identity() / 3).norm(), 0.006);
}

}  // namespace
}  // namespace polyslip::core
