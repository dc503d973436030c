// The orientation distribution function: against the plain sum, closed forms, and direct counting.

#include "results/analysis/odf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/rotation.hpp"
#include "core/texture.hpp"
#include "results/analysis/components.hpp"

namespace {

using namespace polyslip;
using namespace polyslip::results::analysis;
using core::Quaternion;

constexpr double degree = std::numbers::pi / 180;

std::vector<Quaternion> random_orientations(int count, std::uint64_t seed = 1) {
  core::Random random(seed, core::Stream::tests);
  std::vector<Quaternion> q;
  for (int i = 0; i < count; ++i) q.push_back(random.rotation());
  return q;
}

/// A rolling texture: copper, s and brass with spreads, and a random rest.
std::vector<Quaternion> texture(int count) {
  std::vector<core::TextureComponent> parts;
  for (const auto& c : rolling_components()) {
    if (c.name != "copper" && c.name != "s" && c.name != "brass") continue;
    parts.push_back({.kind = core::TextureComponent::Kind::orientation,
                     .orientation = c.variants[0],
                     .half_width = 12 * degree,
                     .orthorhombic = true,
                     .share = 1});
  }
  parts.push_back({.share = 1});
  core::Random random(4, core::Stream::tests);
  return core::random_texture(random, parts, count);
}

/// The definition, term by term.
double plain_odf(const Sample& sample, double half_width, const Quaternion& q) {
  const Kernel kernel(half_width);
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    weights += sample.weights[i];
    for (const auto& s : core::cubic_symmetries())
      sum += sample.weights[i] * kernel.rotation(q.dot(sample.orientations[i] * s)) / 24;
  }
  return sum / weights;
}

TEST(Kernel, HasItsHalfWidthAndTheMeanOne) {
  for (const double width : {3.0, 10.0, 30.0}) {
    const Kernel k(width * degree);
    EXPECT_NEAR(k.rotation(std::cos(width * degree / 2)), 0.5 * k.peak(), 1e-9 * k.peak());
    // The angle of random rotations has the density (2/pi) sin^2(w/2) on [0, pi].
    double mean = 0, pole = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double w = std::numbers::pi * (i + 0.5) / n;
      mean += k.rotation(std::cos(w / 2)) * 2 * std::pow(std::sin(w / 2), 2) / n;
      pole += k.pole(std::cos(w)) * 0.5 * std::sin(w) * std::numbers::pi / n;
    }
    EXPECT_NEAR(mean, 1, 1e-6) << width;
    EXPECT_NEAR(pole, 1, 1e-6) << width;
  }
  EXPECT_NEAR(Kernel(10 * degree).exponent(), 90.9, 0.05);
  EXPECT_THROW(Kernel(0.0), core::InternalError);
  EXPECT_THROW(Kernel(std::nan("")), core::InternalError);
}

TEST(PowerTable, AgreesWithThePower) {
  for (const double exponent : {5.0, 90.9, 1000.0}) {
    const PowerTable table(exponent);
    EXPECT_NEAR(std::pow(table.least(), exponent), PowerTable::negligible, 1e-12);
    for (int i = 0; i <= 5000; ++i) {
      const double x = std::min(table.least() + (1 + 1e-12 - table.least()) * i / 5000, 1 + 1e-12);
      EXPECT_NEAR(table(x), std::pow(x, exponent), 1e-9 * std::pow(x, exponent)) << x;
    }
  }
}

TEST(Odf, OfOneOrientationIsTheKernel) {
  const Quaternion q = core::from_bunge({31, 52, 17});
  const Odf odf({{q}, {3.5}}, 10 * degree);
  const Kernel& k = odf.kernel();
  core::Random random(2, core::Stream::tests);
  for (int i = 0; i < 200; ++i) {
    const double angle = random.uniform(0, 30) * degree;
    const core::Vec3 axis = random.rotation() * core::Vec3::UnitX();
    const Quaternion g = core::exp_axial(axis * angle) * q * core::cubic_symmetries()[i % 24];
    double variants = 0;  // the other 23 are 32 degrees away or more
    for (const auto& s : core::cubic_symmetries()) variants += k.rotation(g.dot(q * s)) / 24;
    EXPECT_NEAR(odf.at(g), variants, 2e-6 * k.peak() / 24);
    EXPECT_GE(odf.at(g), k.rotation(std::cos(angle / 2)) / 24 * (1 - 1e-6));
  }
}

TEST(Odf, CellsAgreeWithThePlainSum) {
  for (const double width : {5.0, 10.0, 20.0}) {
    auto orientations = texture(4000);
    Sample sample = equally_weighted(orientations);
    for (std::size_t i = 0; i < sample.size(); ++i) sample.weights[i] = 1 + 0.1 * (i % 7);
    const Odf odf(sample, width * degree);
    double largest = 0, error = 0;
    for (const auto& q : random_orientations(150, 7)) {
      const double plain = plain_odf(sample, width * degree, q);
      largest = std::max(largest, plain);
      error = std::max(error, std::abs(odf.at(q) - plain));
    }
    EXPECT_GT(largest, 1);
    EXPECT_LT(error, 1e-3 * largest) << width;
    std::printf("half-width %g: largest %.3f, error %.2e\n", width, largest, error);
  }
}

TEST(Odf, IsAlikeForAlikeCrystalsAndSamples) {
  const Sample sample = equally_weighted(texture(500));
  const Odf odf(sample, 10 * degree), rolled(sample, 10 * degree, SampleSymmetry::orthorhombic);
  for (const auto& q : random_orientations(20)) {
    for (const auto& s : core::cubic_symmetries()) EXPECT_NEAR(odf.at(q * s), odf.at(q), 1e-9);
    double mean = 0;
    for (const auto& turn : sample_symmetries(SampleSymmetry::orthorhombic)) {
      mean += odf.at(turn * q) / 4;
      EXPECT_NEAR(rolled.at(turn * q), rolled.at(q), 1e-9);
    }
    EXPECT_NEAR(rolled.at(q), mean, 1e-9);
  }
}

TEST(Odf, IntegratesToOne) {
  const Quaternion q = core::from_bunge({31, 52, 17});
  for (const double width : {6.0, 10.0, 25.0}) {
    const Odf single({{q}, {1}}, width * degree);
    const OdfIntegrals i = integrals(single);
    EXPECT_NEAR(i.mean, 1, 1e-4) << width;
    // Mean of K^2 is K of twice the exponent: C(kappa)^2 / C(2 kappa), if variants do not overlap.
    const double kappa = single.kernel().exponent();
    const auto peak = [](double k) {
      return std::numbers::pi / 2 *
             std::exp(std::lgamma(k + 2) - std::lgamma(1.5) - std::lgamma(k + 0.5));
    };
    const double index = std::pow(peak(kappa), 2) / peak(2 * kappa) / 24;
    if (width > 20) continue;
    EXPECT_NEAR(i.texture_index, index, 1e-3 * index) << width;
  }
  EXPECT_NEAR(integrals(Odf(equally_weighted(texture(2000)), 10 * degree)).mean, 1, 1e-4);
}

// The variance of f at a place, for N random orientations, is (J - 1)/N, J being the index of one
// orientation's own density.
TEST(Odf, OfRandomOrientationsIsOneWithinTheSamplingError) {
  const int count = 20000;
  const Odf odf(equally_weighted(random_orientations(count)), 10 * degree);
  const Odf single({{Quaternion::Identity()}, {1}}, 10 * degree);
  const double deviation = std::sqrt((integrals(single).texture_index - 1) / count);
  const auto places = random_orientations(2000, 9);
  double square = 0, worst = 0;
  for (const double f : odf.at(places)) {
    square += (f - 1) * (f - 1) / static_cast<double>(places.size());
    worst = std::max(worst, std::abs(f - 1));
  }
  EXPECT_NEAR(std::sqrt(square), deviation, 0.15 * deviation);
  EXPECT_LT(worst, 5 * deviation);
  EXPECT_LT(deviation, 0.04);
}

TEST(Odf, DoesNotDependOnThreads) {
  const Odf odf(equally_weighted(texture(300)), 10 * degree);
  const auto places = random_orientations(50);
  EXPECT_EQ(odf.at(places, 1), odf.at(places, 3));
}

TEST(Odf, RefusesWhatIsNoSample) {
  EXPECT_THROW(Odf({{}, {}}, 0.2), core::InternalError);
  EXPECT_THROW(Odf({{Quaternion::Identity()}, {0}}, 0.2), core::InternalError);
  EXPECT_THROW(Odf({{Quaternion::Identity()}, {1, 1}}, 0.2), core::InternalError);
  EXPECT_THROW(Odf({{Quaternion(std::nan(""), 0, 0, 0)}, {1}}, 0.2), core::InternalError);
}

TEST(GaussRule, IsExactForPolynomials) {
  for (const int n : {1, 2, 5, 20}) {
    const auto rule = gauss_rule(n);
    for (int power = 0; power < 2 * n; ++power) {
      double sum = 0;
      for (const auto& [x, w] : rule) sum += w * std::pow(x, power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-13) << n << ' ' << power;
    }
  }
}

}  // namespace
