// Pole figures: closed forms, direct counting, projections, colours.

#include "results/analysis/pole_figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "core/rotation.hpp"
#include "core/texture.hpp"
#include "results/analysis/components.hpp"
#include "results/analysis/odf.hpp"

namespace {

using namespace polyslip;
using namespace polyslip::results::analysis;
using core::Quaternion;
using core::Vec3;

constexpr double degree = std::numbers::pi / 180;

/// Orientations about copper's variants.
std::vector<Quaternion> copper(int count) {
  core::Random random(6, core::Stream::tests);
  const Component* c = nullptr;
  for (const auto& each : rolling_components())
    if (each.name == "copper") c = &each;
  return core::random_texture(random,
                              {{.kind = core::TextureComponent::Kind::orientation,
                                .orientation = c->variants[0],
                                .half_width = 15 * degree,
                                .orthorhombic = true,
                                .share = 2},
                               {.share = 1}},
                              count);
}

TEST(PoleFigure, FamiliesHaveTheirMembers) {
  EXPECT_EQ(crystal_family({1, 1, 1}).size(), 8u);
  EXPECT_EQ(crystal_family({2, 0, 0}).size(), 6u);
  EXPECT_EQ(crystal_family({2, 2, 0}).size(), 12u);
  EXPECT_EQ(crystal_family({1, 2, 3}).size(), 48u);
}

TEST(PoleFigure, OfOneCrystalIsTheKernelsPoles) {
  const Quaternion q = core::from_bunge({20, 35, 60});
  const Kernel kernel(10 * degree);
  core::Random random(3, core::Stream::tests);
  for (const auto& hkl : {std::array{1, 1, 1}, std::array{2, 0, 0}, std::array{2, 2, 0}}) {
    const PoleFigure figure({{q}, {2}}, hkl, 10 * degree);
    const auto family = crystal_family(hkl);
    for (int i = 0; i < 100; ++i) {
      const Vec3 r = random.rotation() * Vec3::UnitZ();
      double sum = 0;
      for (const Vec3& h : family)
        sum += kernel.pole(r.dot(q * h)) / static_cast<double>(family.size());
      EXPECT_NEAR(figure.at(r), sum, 2e-6 * kernel.pole(1));
      EXPECT_NEAR(figure.at(-3 * r), figure.at(r), 1e-9);
    }
  }
}

// The kernel's pole density is the mean of its rotations that take the pole there.
TEST(PoleFigure, IsTheProjectionOfTheOdf) {
  const Sample sample = equally_weighted(copper(200));
  const PoleFigure figure(sample, {1, 1, 1}, 15 * degree);
  const Odf odf(sample, 15 * degree);
  const Vec3 h = Vec3(1, 1, 1).normalized();
  core::Random random(8, core::Stream::tests);
  for (int i = 0; i < 10; ++i) {
    const Vec3 r = random.rotation() * Vec3::UnitZ();
    double mean = 0;
    const int n = 360;
    for (int k = 0; k < n; ++k)
      mean += odf.at(core::exp_axial(r * (2 * std::numbers::pi * k / n)) *
                     Quaternion::FromTwoVectors(h, r)) /
              n;
    EXPECT_NEAR(figure.at(r), mean, 2e-3 * (1 + mean));
  }
}

// Poles counted in caps of 12 degrees, against the density's mean over the cap.
TEST(PoleFigure, AgreesWithDirectBinning) {
  const auto orientations = copper(20000);
  const auto family = crystal_family({1, 1, 1});
  const PoleFigure figure(equally_weighted(orientations), {1, 1, 1}, 3 * degree);
  core::Random random(9, core::Stream::tests);
  const double cap = 12 * degree, share = (1 - std::cos(cap)) / 2;
  for (int i = 0; i < 12; ++i) {
    const Vec3 r = random.rotation() * Vec3::UnitZ();
    long inside = 0;
    for (const auto& q : orientations)
      for (const Vec3& h : family) inside += r.dot(q * h) > std::cos(cap);
    const double counted = static_cast<double>(inside) /
                           static_cast<double>(orientations.size() * family.size()) / share;
    double mean = 0;
    const int points = 2000;
    for (int k = 0; k < points; ++k) {  // equal areas along a spiral
      const double z = 1 - (1 - std::cos(cap)) * (k + 0.5) / points, a = 2.39996323 * k;
      const double s = std::sqrt(1 - z * z);
      mean += figure.at(Quaternion::FromTwoVectors(Vec3::UnitZ(), r) *
                        Vec3(s * std::cos(a), s * std::sin(a), z)) /
              points;
    }
    // What the kernel smooths over the cap's edge, and its sampling.
    EXPECT_NEAR(mean, counted, 0.03 * counted + 0.02) << r.transpose();
  }
}

TEST(PoleFigure, MeansOverTheSphereAreOne) {
  const Sample sample = equally_weighted(copper(300));
  const PoleFigure figure(sample, {2, 2, 0}, 10 * degree);
  const InversePoleFigure inverse(sample, Vec3::UnitZ(), 10 * degree);
  double direct = 0, reverse = 0;
  const int points = 4000;
  for (int k = 0; k < points; ++k) {
    const double z = 1 - 2 * (k + 0.5) / points, a = 2.39996323 * k, s = std::sqrt(1 - z * z);
    const Vec3 d(s * std::cos(a), s * std::sin(a), z);
    direct += figure.at(d) / points;
    reverse += inverse.at(d) / points;
  }
  EXPECT_NEAR(direct, 1, 2e-3);
  EXPECT_NEAR(reverse, 1, 2e-3);
}

TEST(InversePoleFigure, OfOneCrystal) {
  const Quaternion q = core::from_bunge({20, 35, 60});
  const Kernel kernel(10 * degree);
  const InversePoleFigure figure({{q}, {1}}, Vec3::UnitX(), 10 * degree);
  core::Random random(3, core::Stream::tests);
  for (int i = 0; i < 50; ++i) {
    const Vec3 d = random.rotation() * Vec3::UnitZ();
    double sum = 0;
    for (const auto& s : core::cubic_symmetries())
      for (const double sign : {1.0, -1.0})
        sum += kernel.pole(sign * (s * d).dot(q.conjugate() * Vec3::UnitX())) / 48;
    EXPECT_NEAR(figure.at(d), sum, 2e-6 * kernel.pole(1));
  }
}

TEST(Projection, KeepsAreasAndGoesBack) {
  core::Random random(1, core::Stream::tests);
  int inner = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    Vec3 d = random.rotation() * Vec3::UnitZ();
    d[2] = std::abs(d[2]);
    const Eigen::Vector2d place = equal_area(d);
    ASSERT_LE(place.norm(), 1 + 1e-12);
    EXPECT_LT((from_equal_area(place) - d).norm(), 1e-12);
    inner += place.norm() < 0.5;
  }
  EXPECT_NEAR(inner / static_cast<double>(n), 0.25, 0.015);
}

TEST(Colours, OfTheTrianglesCorners) {
  EXPECT_LT((triangle_colour({0, 0, -2}) - Vec3(255, 0, 0)).norm(), 1e-9);
  EXPECT_LT((triangle_colour({1, 0, 1}) - Vec3(0, 255, 0)).norm(), 1e-9);
  EXPECT_LT((triangle_colour({-1, 1, 1}) - Vec3(0, 0, 255)).norm(), 1e-9);
  core::Random random(1, core::Stream::tests);
  for (int i = 0; i < 100; ++i) {
    const Quaternion q = random.rotation();
    const Vec3 colour = inverse_pole_colour(q, Vec3::UnitZ());
    EXPECT_DOUBLE_EQ(colour.maxCoeff(), 255);
    EXPECT_GE(colour.minCoeff(), 0);
    for (const auto& s : core::cubic_symmetries())
      EXPECT_LT((inverse_pole_colour(q * s, Vec3::UnitZ()) - colour).norm(), 1e-9);
  }
}

}  // namespace
