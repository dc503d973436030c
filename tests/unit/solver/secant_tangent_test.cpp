#include "solver/secant_tangent.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "core/random.hpp"
#include "core/tensor.hpp"

namespace polyslip::solver {
namespace {

constexpr int lanes = 4;
using Mat6x9 = Eigen::Matrix<double, 6, 9>;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Vec9 = Eigen::Matrix<double, 9, 1>;

/// A block of four points: symmetric positive on deviators, with a part that sees the spin.
struct Block {
  std::array<double, 9 * lanes> h{};
  std::array<double, 6 * lanes> change{};
  std::array<double, 54 * lanes> tangent{};

  Vec9 gradient(int lane) const { return column<9>(h, lane); }
  Vec6 stress(int lane) const { return column<6>(change, lane); }
  Mat6x9 matrix(int lane) const {
    Mat6x9 D;
    for (int m = 0; m < 6; ++m)
      for (int k = 0; k < 9; ++k) D(m, k) = tangent[lanes * (9 * m + k) + lane];
    return D;
  }

 private:
  template <int n, class Values>
  static Eigen::Matrix<double, n, 1> column(const Values& values, int lane) {
    Eigen::Matrix<double, n, 1> v;
    for (int k = 0; k < n; ++k) v[k] = values[lanes * k + lane];
    return v;
  }
};

/// [9 x 5] entry 3 k + l and [6 x 5] Mandel components of the orthonormal deviators.
Eigen::Matrix<double, 9, 5> plain_modes() {
  Eigen::Matrix<double, 9, 5> modes;
  for (int m = 0; m < 5; ++m) {
    const core::Mat3 t = core::from_deviator5(core::Vec5::Unit(m));
    for (int k = 0; k < 9; ++k) modes(k, m) = t(k / 3, k % 3);
  }
  return modes;
}
Eigen::Matrix<double, 6, 5> mandel_modes() {
  Eigen::Matrix<double, 6, 5> modes;
  for (int m = 0; m < 5; ++m) modes.col(m) = core::mandel_of_deviator5(core::Vec5::Unit(m));
  return modes;
}

Eigen::Matrix<double, 5, 5> random_moduli(core::Random& random) {
  Eigen::Matrix<double, 5, 5> A;
  for (double& a : A.reshaped()) a = random.uniform(-1, 1);
  return A * A.transpose() + 0.1 * Eigen::Matrix<double, 5, 5>::Identity();
}

Vec9 skew(core::Random& random) {
  const double a = random.uniform(-1, 1), b = random.uniform(-1, 1), c = random.uniform(-1, 1);
  return (Vec9() << 0, a, b, -a, 0, c, -b, -c, 0).finished();
}

/// Stress changes by other moduli than the tangent's, and
/// by what the tangent makes of the spin.
Block random_block(std::uint64_t seed) {
  core::Random random(seed, core::Stream::tests);
  Block block;
  for (int lane = 0; lane < lanes; ++lane) {
    const auto now = random_moduli(random), chord = random_moduli(random);
    Mat6x9 D = mandel_modes() * now * plain_modes().transpose();
    const Vec9 spin = skew(random);
    for (int m = 0; m < 6; ++m) D.row(m) += random.uniform(-1, 1) * spin.transpose();
    core::Vec5 s;
    for (double& c : s) c = 1e-3 * random.uniform(-1, 1);
    const Vec9 h = plain_modes() * s + 1e-3 * skew(random);
    const Vec9 rest = h - plain_modes() * s;
    const Vec6 change = mandel_modes() * (chord * s) + D * rest;
    for (int k = 0; k < 9; ++k) block.h[lanes * k + lane] = h[k];
    for (int m = 0; m < 6; ++m) block.change[lanes * m + lane] = change[m];
    for (int m = 0; m < 6; ++m)
      for (int k = 0; k < 9; ++k) block.tangent[lanes * (9 * m + k) + lane] = D(m, k);
  }
  return block;
}

void match(Block& block, double stiffest) {
  match_last_change(block.h.data(), block.change.data(), stiffest, block.tangent.data());
}

TEST(SecantTangent, MapsTheLastChangeOfTheGradientsToThatOfTheStress) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Block before = random_block(seed);
    Block after = before;
    match(after, 1e3);
    for (int lane = 0; lane < lanes; ++lane) {
      const Vec6 wanted = after.stress(lane), got = after.matrix(lane) * after.gradient(lane);
      EXPECT_GT((before.matrix(lane) * after.gradient(lane) - wanted).norm(), 1e-3 * wanted.norm());
      EXPECT_LT((got - wanted).norm(), 1e-12 * wanted.norm());
    }
  }
}

TEST(SecantTangent, StaysSymmetricAndPositiveOnDeviatorsAndKeepsWhatItMakesOfSpins) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Block before = random_block(seed);
    Block after = before;
    match(after, 1e3);
    core::Random random(seed, core::Stream::tests);
    for (int lane = 0; lane < lanes; ++lane) {
      const Eigen::Matrix<double, 5, 5> D =
          mandel_modes().transpose() * after.matrix(lane) * plain_modes();
      EXPECT_LT((D - D.transpose()).norm(), 1e-12 * D.norm());
      EXPECT_GT(D.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
      const Vec9 spin = skew(random);
      EXPECT_LT((after.matrix(lane) * spin - before.matrix(lane) * spin).norm(), 1e-12);
    }
  }
}

TEST(SecantTangent, IsTheLawsWhereTheLawIsLinear) {
  Block block = random_block(3);
  for (int lane = 0; lane < lanes; ++lane) {
    const Vec6 linear = block.matrix(lane) * block.gradient(lane);
    for (int m = 0; m < 6; ++m) block.change[lanes * m + lane] = linear[m];
  }
  Block after = block;
  match(after, 1e3);
  for (std::size_t i = 0; i < block.tangent.size(); ++i)
    EXPECT_NEAR(after.tangent[i], block.tangent[i], 1e-11);
}

/// Softening, no change at all (the lanes that fill a block), stiffer than can be: each in a lane.
TEST(SecantTangent, LeavesAlonePointsThatNoChordCanDescribe) {
  Block block = random_block(4);
  for (int m = 0; m < 6; ++m) block.change[lanes * m] *= -1;
  for (int m = 0; m < 6; ++m) block.change[lanes * m + 1] = 0;
  for (int k = 0; k < 9; ++k) block.h[lanes * k + 1] = 0;
  for (int m = 0; m < 6; ++m) block.change[lanes * m + 2] *= 1e6;
  Block after = block;
  match(after, 1e3);
  for (int lane = 0; lane < 3; ++lane) EXPECT_EQ(after.matrix(lane), block.matrix(lane)) << lane;
  EXPECT_NE(after.matrix(3), block.matrix(3));
}

}  // namespace
}  // namespace polyslip::solver
