#include "core/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/rotation.hpp"

namespace polyslip::core {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Mean and the standard error of it.
struct Mean {
  double value = 0, error = 0;
};
template <class Draw>
Mean mean_of(int count, Draw&& draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double x = draw();
    sum += x;
    squares += x * x;
  }
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / count)};
}

void expect_mean(const Mean& mean, double expected) {
  EXPECT_GT(mean.error, 0);
  EXPECT_LT(std::abs(mean.value - expected), 4 * mean.error) << mean.value << " " << expected;
}

TEST(Texture, MillerIndicesLieAlongTheSamplesAxes) {
  for (const auto& named : named_orientations()) {
    const Quaternion q = miller_orientation(named.plane, named.direction);
    EXPECT_EQ(named.plane.dot(named.direction), 0) << named.name;
    EXPECT_LT((q * named.plane.normalized() - Vec3::UnitZ()).norm(), 1e-14) << named.name;
    EXPECT_LT((q * named.direction.normalized() - Vec3::UnitX()).norm(), 1e-14) << named.name;
  }
  EXPECT_THROW(miller_orientation({0, 0, 1}, {0, 0, 2}), InputError);
  EXPECT_THROW(miller_orientation({0, 0, 0}, {0, 0, 2}), InputError);
}

// Bunge's angles of the ideal orientations as tables have them (to a degree).
TEST(Texture, NamesMeanWhatTablesSay) {
  const auto nearest = [](const std::string& name, const Vec3& bunge) {
    double least = 180;
    for (const auto& named : named_orientations()) {
      if (named.name != name) continue;
      const Quaternion q = miller_orientation(named.plane, named.direction);
      // Tables give any one of the four variants of orthorhombic sample symmetry.
      for (const Quaternion& turn : {Quaternion(1, 0, 0, 0), Quaternion(0, 1, 0, 0),
                                     Quaternion(0, 0, 1, 0), Quaternion(0, 0, 0, 1)})
        least = std::min(least, disorientation_angle(turn * q, from_bunge(bunge)) / degree);
    }
    return least;
  };
  EXPECT_LT(nearest("cube", {0, 0, 0}), 1e-6);
  EXPECT_LT(nearest("goss", {0, 45, 0}), 1e-6);
  EXPECT_LT(nearest("brass", {35.26, 45, 0}), 0.02);
  EXPECT_LT(nearest("copper", {90, 35.26, 45}), 0.02);
  EXPECT_LT(nearest("s", {58.98, 36.70, 63.43}), 0.02);
  EXPECT_LT(nearest("dillamore", {90, 27.21, 45}), 0.02);
  EXPECT_LT(nearest("rotated-cube", {45, 0, 0}), 1e-6);
}

TEST(Texture, KernelIsHalfItsMaximumAtItsHalfWidth) {
  for (const double width : {1.0, 10.0, 60.0}) {
    const double kappa = kernel_exponent(width * degree);
    EXPECT_NEAR(std::pow(std::cos(width * degree / 2), 2 * kappa), 0.5, 1e-12);
  }
  EXPECT_NEAR(kernel_exponent(10 * degree), 90.9, 0.05);
}

TEST(Texture, GammaNumbersHaveTheMeanAndVarianceOfTheirShape) {
  Random random(3, Stream::tests);
  for (const double shape : {0.5, 1.0, 4.5, 90.9}) {
    expect_mean(mean_of(40000, [&] { return random_gamma(random, shape); }), shape);
    expect_mean(mean_of(40000, [&] { return std::pow(random_gamma(random, shape) - shape, 2); }),
                shape);
  }
}

TEST(Texture, SpreadHasTheMomentsOfItsKernel) {
  Random random(5, Stream::tests);
  for (const double width : {2.0, 10.0, 40.0, 100.0}) {
    const double kappa = kernel_exponent(width * degree), a = 1.5, b = kappa + 0.5, n = a + b;
    const auto draw = [&] { return random_spread(random, kappa).vec().squaredNorm(); };
    expect_mean(mean_of(40000, draw), a / n);
    // Second moment of the Beta distribution.
    expect_mean(mean_of(40000, [&] { return std::pow(draw(), 2); }), a * (a + 1) / (n * (n + 1)));
    // The axis is uniform.
    for (int axis = 0; axis < 3; ++axis)
      expect_mean(mean_of(20000,
                          [&] {
                            const Vec3 v = random_spread(random, kappa).vec();
                            return v[axis] * v[axis] / v.squaredNorm();
                          }),
                  1.0 / 3);
  }
}

TEST(Texture, NarrowSpreadIsNormalAboutEachAxis) {
  Random random(6, Stream::tests);
  const double width = 3 * degree, sigma = width / std::sqrt(2 * std::numbers::ln2);
  const Mean mean = mean_of(40000, [&] {
    const Quaternion q = random_spread(random, kernel_exponent(width));
    return std::pow(rotation_angle(q) / sigma, 2);
  });
  EXPECT_NEAR(mean.value, 3, 4 * mean.error + 0.01);  // 0.01: the kernel is normal for narrow ones
}

TEST(Texture, FibreKeepsItsDirectionsTogether) {
  TextureComponent fibre;
  fibre.kind = TextureComponent::Kind::fibre;
  fibre.crystal = {1, 1, 1};
  fibre.sample = {0, 0, 2};
  Random random(7, Stream::tests);
  const auto cosine = [&] {
    return (random_orientation(random, fibre) * fibre.crystal.normalized()).z();
  };
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(cosine(), 1, 1e-14);
  // Turns about the fibre are all alike: another direction has no mean across it.
  for (int axis = 0; axis < 2; ++axis)
    expect_mean(
        mean_of(20000, [&] { return (random_orientation(random, fibre) * Vec3::UnitX())[axis]; }),
        0);
  fibre.half_width = 15 * degree;
  const double kappa = kernel_exponent(fibre.half_width);
  expect_mean(mean_of(40000, cosine), kappa / (kappa + 2));
}

TEST(Texture, SharesAreKeptAndDrawsFollowTheSeed) {
  TextureComponent cube, goss;
  cube.kind = goss.kind = TextureComponent::Kind::orientation;
  goss.orientation = miller_orientation({0, 1, 1}, {1, 0, 0});
  cube.share = 3;
  goss.share = 1;
  const auto draw = [&](std::uint64_t seed) {
    Random random(seed, Stream::tests);
    return random_texture(random, {cube, TextureComponent{}, goss}, 101);
  };
  const auto some = draw(1), again = draw(1), other = draw(2);
  ASSERT_EQ(some.size(), 101U);
  int cubes = 0, gosses = 0, moved = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].coeffs(), again[i].coeffs());
    moved += some[i].coeffs() != other[i].coeffs();
    cubes += disorientation_angle(some[i], cube.orientation) < 1e-9;
    gosses += disorientation_angle(some[i], goss.orientation) < 1e-9;
  }
  EXPECT_EQ(cubes, 61);  // 60.6, 20.2 and 20.2
  EXPECT_EQ(gosses, 20);
  EXPECT_GT(moved, 50);
}

TEST(Texture, OrthorhombicVariantsAreAlikeInNumber) {
  TextureComponent s;
  s.kind = TextureComponent::Kind::orientation;
  s.orientation = miller_orientation({1, 2, 3}, {6, 3, -4});
  s.orthorhombic = true;
  Random random(8, Stream::tests);
  // The half turn about z keeps the plane normal along z; those about x and y turn it over.
  const auto kept = [&] {
    const Quaternion q = random_orientation(random, s);
    return (q * Vec3(1, 2, 3)).z() > 0 ? 1.0 : 0.0;
  };
  const auto same = [&] {
    const Quaternion q = random_orientation(random, s);
    return rotation_angle(q.conjugate() * s.orientation) < 1e-9 ? 1.0 : 0.0;
  };
  expect_mean(mean_of(4000, kept), 0.5);
  expect_mean(mean_of(4000, same), 0.25);
}

}  // namespace
}  // namespace polyslip::core
