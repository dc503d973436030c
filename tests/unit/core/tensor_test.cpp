#include "core/tensor.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "core/rotation.hpp"

namespace polyslip::core {
namespace {

Mat3 random_matrix(Random& random) {
  return Mat3::NullaryExpr([&] { return random.uniform(-1, 1); });
}

TEST(Tensor, MandelKeepsTheScalarProductAndComesBack) {
  Random random(1, Stream::tests);
  const Mat3 a = symmetric_part(random_matrix(random)), b = symmetric_part(random_matrix(random));
  EXPECT_NEAR(mandel(a).dot(mandel(b)), (a * b).trace(), 1e-15);
  EXPECT_LT((from_mandel(mandel(a)) - a).norm(), 1e-15);
  EXPECT_GT(a.norm(), 0.1);
}

TEST(Tensor, MandelOrderIsXxYyZzYzZxXy) {
  Mat3 a;
  a << 1, 6, 5, 6, 2, 4, 5, 4, 3;
  const Vec6 v = mandel(a);
  const double expected[6] = {1, 2, 3, 4 * sqrt2, 5 * sqrt2, 6 * sqrt2};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(v[i], expected[i], 1e-14) << i;
}

TEST(Tensor, DeviatorBasisIsOrthonormalAndTraceFree) {
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const Mat3 b_i = from_deviator5(Vec5::Unit(i)), b_j = from_deviator5(Vec5::Unit(j));
      EXPECT_NEAR(b_i.trace(), 0, 1e-15);
      EXPECT_NEAR((b_i * b_j.transpose()).trace(), i == j ? 1 : 0, 1e-15);
    }
}

TEST(Tensor, DeviatorsComeBackDirectlyAndThroughMandel) {
  Random random(2, Stream::tests);
  const Mat3 a = deviator(symmetric_part(random_matrix(random)));
  EXPECT_LT((from_deviator5(deviator5(a)) - a).norm(), 1e-15);
  EXPECT_LT((mandel_of_deviator5(deviator5(a)) - mandel(a)).norm(), 1e-15);
  EXPECT_LT((deviator5_of_mandel(mandel(a)) - deviator5(a)).norm(), 1e-15);
  EXPECT_GT(a.norm(), 0.1);
}

TEST(Tensor, RotationOfDeviatorsIsOrthogonalAndRotates) {
  Random random(3, Stream::tests);
  const Mat3 q = to_matrix(random.rotation());
  const Mat3 a = deviator(symmetric_part(random_matrix(random)));
  const Mat5 m = deviator5_rotation(q);
  EXPECT_LT((m * m.transpose() - Mat5::Identity()).norm(), 1e-14);
  EXPECT_LT((m * deviator5(a) - deviator5(q * a * q.transpose())).norm(), 1e-15);
}

TEST(Tensor, SkewIsTheCrossProductAndAxialItsInverse) {
  const Vec3 v(1, -2, 3), x(0.3, 0.5, -0.7);
  EXPECT_LT((skew(v) * x - v.cross(x)).norm(), 1e-15);
  EXPECT_LT((axial(skew(v) + Mat3::Ones()) - v).norm(), 1e-15);
}

// Plane strain compression by 1: sqrt(2/3 (1 + 1)) = 2/sqrt 3. Tension by s: s.
TEST(Tensor, EquivalentsAreVonMises) {
  const Mat3 d = Vec3(1, 0, -1).asDiagonal();
  EXPECT_NEAR(equivalent_strain(d), 2 * inv_sqrt3, 1e-15);
  const Mat3 s = Vec3(7, 0, 0).asDiagonal();
  EXPECT_NEAR(equivalent_stress(s), 7, 1e-14);
}

}  // namespace
}  // namespace polyslip::core
