#include "core/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/tensor.hpp"

namespace polyslip::core {
namespace {

constexpr double degree = 1 / degrees_per_radian;

double distance(const Quaternion& a, const Quaternion& b) {
  return rotation_angle(a.conjugate() * b);
}

/// Orientation {plane}<direction> of rolling: z = ND along `plane`, x = RD along `direction`.
Quaternion rolling(const Vec3& plane, const Vec3& direction) {
  const Vec3 z = plane.normalized(), x = direction.normalized();
  Mat3 sample_axes;  // rows: RD, TD, ND in the crystal frame, so it turns crystal into sample
  sample_axes << x.transpose(), z.cross(x).transpose(), z.transpose();
  return from_matrix(sample_axes);
}

TEST(Rotation, ConversionsComeBack) {
  Random random(1, Stream::tests);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = random.rotation();
    ASSERT_LT(distance(from_matrix(to_matrix(q)), q), 1e-14);
    ASSERT_LT(distance(from_rodrigues(to_rodrigues(q)), q), 1e-14);
    const Vec3 euler = to_bunge(q);
    ASSERT_LT(distance(from_bunge(euler), q), 1e-13);
    ASSERT_TRUE(euler[0] >= 0 && euler[0] < 360 && euler[2] >= 0 && euler[2] < 360);
    ASSERT_TRUE(euler[1] >= 0 && euler[1] <= 180);
  }
}

TEST(Rotation, MatrixTurnsCrystalAxesIntoSampleAxes) {
  // 90 degrees about z: the crystal's [100] lies along the sample's y.
  const Quaternion q(std::cos(45 * degree), 0, 0, std::sin(45 * degree));
  EXPECT_LT((to_matrix(q) * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((to_rodrigues(q) - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((to_bunge(q) - Vec3(90, 0, 0)).norm(), 1e-12);
}

TEST(Rotation, BungeAnglesAreZXZ) {
  const Vec3 euler(30, 50, 70);
  const Mat3 expected = (Eigen::AngleAxisd(30 * degree, Vec3::UnitZ()) *
                         Eigen::AngleAxisd(50 * degree, Vec3::UnitX()) *
                         Eigen::AngleAxisd(70 * degree, Vec3::UnitZ()))
                            .toRotationMatrix();
  EXPECT_LT((to_matrix(from_bunge(euler)) - expected).norm(), 1e-15);
  EXPECT_NEAR(to_matrix(from_bunge(euler))(2, 2), std::cos(50 * degree), 1e-15);
  EXPECT_LT((to_bunge(from_bunge(euler)) - euler).norm(), 1e-12);
}

TEST(Rotation, BungeAnglesAtTheirPoles) {
  for (const Vec3& euler : {Vec3(20, 0, 30), Vec3(20, 180, 30), Vec3(0, 0, 0), Vec3(359, 0, 2)}) {
    const Quaternion q = from_bunge(euler);
    const Vec3 back = to_bunge(q);
    EXPECT_LT(distance(from_bunge(back), q), 1e-13);
    EXPECT_EQ(back[2], 0);
  }
}

// Copper is (90, 35.26, 45), brass (35.26, 45, 0), Goss (0, 45, 0) in every textbook's tables.
TEST(Rotation, TextbookEulerAnglesGiveTheRollingComponents) {
  const double a = std::atan(std::sqrt(0.5)) * degrees_per_radian;
  EXPECT_LT(disorientation_angle(from_bunge({90, a, 45}), rolling({1, 1, 2}, {-1, -1, 1})), 1e-7);
  EXPECT_LT(disorientation_angle(from_bunge({a, 45, 0}), rolling({0, 1, 1}, {2, -1, 1})), 1e-7);
  EXPECT_LT(disorientation_angle(from_bunge({0, 45, 0}), rolling({0, 1, 1}, {1, 0, 0})), 1e-7);
}

TEST(Rotation, ExponentialIsThatOfTheSkewMatrix) {
  for (const Vec3& v : {Vec3(0.3, -0.2, 0.9), Vec3(3e-5, 5e-5, -2e-5), Vec3(1e-9, 0, 0)}) {
    const Mat3 expected = skew(v).exp();
    EXPECT_LT((to_matrix(exp_axial(v)) - expected).norm(), 1e-15 * (1 + 10 * v.norm()));
    EXPECT_NEAR(rotation_angle(exp_axial(v)), v.norm(), 1e-15);
  }
  EXPECT_EQ(exp_axial(Vec3::Zero()).w(), 1);
}

TEST(Rotation, CubicSymmetriesAreAGroupOf24) {
  const auto& group = cubic_symmetries();
  EXPECT_EQ(group[0].w(), 1);
  int closed = 0;
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t j = 0; j < 24; ++j) {
      if (i != j) {
        EXPECT_GT(distance(group[i], group[j]), 1);
      }
      for (const auto& s : group) closed += distance(group[i] * group[j], s) < 1e-7;
    }
  EXPECT_EQ(closed, 24 * 24);
}

TEST(Rotation, DisorientationIgnoresSymmetryAndOrder) {
  Random random(2, Stream::tests);
  for (int i = 0; i < 50; ++i) {
    const Quaternion a = random.rotation(), b = random.rotation();
    const double angle = disorientation_angle(a, b);
    EXPECT_GT(angle, 0);
    EXPECT_LT(angle, 62.8 * degree);  // the largest one of cubic crystals is 62.7994 degrees
    EXPECT_NEAR(disorientation_angle(b, a), angle, 1e-12);
    EXPECT_NEAR(disorientation_angle(a * cubic_symmetries()[i % 24], b), angle, 1e-12);
  }
}

TEST(Rotation, DisorientationOfKnownPairs) {
  const Quaternion identity = Quaternion::Identity();
  const Quaternion twin(Eigen::AngleAxisd(60 * degree, Vec3(1, 1, 1).normalized()));
  EXPECT_NEAR(disorientation_angle(identity, twin), 60 * degree, 1e-12);
  const Quaternion goss(Eigen::AngleAxisd(45 * degree, Vec3::UnitX()));
  EXPECT_NEAR(disorientation_angle(identity, goss), 45 * degree, 1e-12);
  const Quaternion beyond(Eigen::AngleAxisd(50 * degree, Vec3::UnitX()));
  EXPECT_NEAR(disorientation_angle(identity, beyond), 40 * degree, 1e-12);
  const Quaternion small = exp_axial({1e-9, 0, 0});
  EXPECT_NEAR(disorientation_angle(identity, small), 1e-9, 1e-15);
  EXPECT_EQ(disorientation_angle(identity, identity), 0);
}

TEST(Rotation, FundamentalRegionIsTheTruncatedCube) {
  Random random(3, Stream::tests);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = random.rotation();
    const Vec3 r = fundamental_rodrigues(q);
    ASSERT_LE(r.cwiseAbs().maxCoeff(), std::sqrt(2.0) - 1 + 1e-12);
    ASSERT_LE(r.cwiseAbs().sum(), 1 + 1e-12);
    ASSERT_LT(disorientation_angle(from_rodrigues(r), q), 1e-7);
    ASSERT_LT((fundamental_rodrigues(q * cubic_symmetries()[i % 24]) - r).norm(), 1e-12);
  }
}

/// Whether one of the four variants of `q` under the symmetry of rolling has Rodrigues vector `r`.
bool is_variant_at(const Quaternion& q, const Vec3& r, double tolerance) {
  for (const Vec3& axis : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const Quaternion turn =
        axis.isZero() ? Quaternion::Identity() : Quaternion(0, axis[0], axis[1], axis[2]);
    if (disorientation_angle(turn * q, from_rodrigues(r)) < tolerance) return true;
  }
  return false;
}

// Fig. 18 of the paper, with the sign of S's second variant corrected: positions to three digits.
TEST(Rotation, RollingComponentsLieWhereThePaperPutsThem) {
  const Quaternion S = rolling({1, 2, 3}, {6, 3, -4});
  for (const Vec3& r : {Vec3(.254, -.235, -.291), Vec3(-.254, .235, -.291),
                        Vec3(-.254, -.235, .291), Vec3(.254, .235, .291)})
    EXPECT_TRUE(is_variant_at(S, r, 0.3 * degree)) << r.transpose();
  EXPECT_FALSE(is_variant_at(S, {-.254, .235, .291}, 5 * degree));
  for (const Vec3& r : {Vec3(-.414, -.132, .318), Vec3(.414, .132, .318)})
    EXPECT_TRUE(is_variant_at(rolling({0, 1, 1}, {2, 1, -1}), r, 0.3 * degree)) << r.transpose();
  for (const Vec3& r : {Vec3(-.132, -.318, .414), Vec3(.132, .318, .414)})
    EXPECT_TRUE(is_variant_at(rolling({1, 1, 2}, {1, 1, -1}), r, 0.3 * degree)) << r.transpose();
}

TEST(Rotation, ColourIsThePapersFormulaAfterReduction) {
  EXPECT_LT((paper_colour(Quaternion::Identity()) - Vec3::Constant(127.5)).norm(), 1e-12);
  const Quaternion q = from_rodrigues({0.1, -0.2, 0.3});
  const double edge = std::sqrt(2.0) - 1;
  const Vec3 expected = 255 * (Vec3(0.1, -0.2, 0.3).array() + edge) / (2 * edge);
  EXPECT_LT((paper_colour(q) - expected).norm(), 1e-11);
  EXPECT_LT((paper_colour(q * cubic_symmetries()[13]) - expected).norm(), 1e-10);
  const Quaternion corner(Eigen::AngleAxisd(45 * degree, Vec3::UnitX()));
  const double red = paper_colour(corner)[0];
  EXPECT_TRUE(std::abs(red) < 1e-10 || std::abs(red - 255) < 1e-10) << red;
}

TEST(Rotation, MeanLiesHalfwayAndIgnoresSigns) {
  const Quaternion a = exp_axial({0.2, 0, 0}), b = exp_axial({0.4, 0, 0});
  EXPECT_LT(distance(mean_rotation(std::vector{a, b}), exp_axial({0.3, 0, 0})), 1e-14);
  const Quaternion minus_b(-b.coeffs());
  const Quaternion mean = mean_rotation(std::vector{a, minus_b});
  EXPECT_LT(distance(mean, exp_axial({0.3, 0, 0})), 1e-14);
  EXPECT_GT(mean.dot(a), 0);
}

TEST(Rotation, MeanIsWeighted) {
  const Quaternion a = exp_axial({0, 0, 0}), b = exp_axial({0, 0, 0.02});
  const std::vector<double> weights{3, 1};
  const Quaternion mean = mean_rotation(std::vector{a, b}, weights);
  EXPECT_NEAR(to_rodrigues(mean)[2], 0.0025, 1e-6);
}

TEST(Rotation, MeanOrientationBringsVariantsTogether) {
  Random random(4, Stream::tests);
  const Quaternion centre = random.rotation();
  std::vector<Quaternion> orientations;
  for (const double s : {-0.1, 0.1})
    for (int axis = 0; axis < 3; ++axis)
      orientations.push_back(centre * exp_axial(s * Vec3::Unit(axis)) *
                             cubic_symmetries()[orientations.size() * 3 + 2]);
  EXPECT_LT(distance(mean_orientation(orientations, orientations[3]),
                     nearest_variant(centre, orientations[3])),
            1e-12);
  EXPECT_GT(disorientation_angle(mean_rotation(orientations), centre), 0.05);
}

TEST(Rotation, MeanRefusesNothingAndNaN) {
  const std::vector<Quaternion> one{Quaternion::Identity()};
  const std::vector<double> zero{0}, nan{std::nan("")}, two{1, 1};
  EXPECT_THROW(mean_rotation({}), InternalError);
  EXPECT_THROW(mean_rotation(one, zero), InternalError);
  EXPECT_THROW(mean_rotation(one, nan), InternalError);
  EXPECT_THROW(mean_rotation(one, two), InternalError);
}

}  // namespace
}  // namespace polyslip::core
