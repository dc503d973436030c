// Ideal orientations: their variants, places, fractions, and the beta-fibre.

#include "results/analysis/components.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/random.hpp"
#include "core/rotation.hpp"

namespace {

using namespace polyslip;
using namespace polyslip::results::analysis;
using core::Quaternion;

constexpr double degree = std::numbers::pi / 180;

const Component& named(const std::string& name) {
  for (const auto& c : rolling_components())
    if (c.name == name) return c;
  throw std::out_of_range(name);
}

TEST(Components, HaveTheirVariants) {
  const std::map<std::string, std::size_t> variants{
      {"cube", 1},   {"goss", 1},      {"brass", 2},       {"s", 4},
      {"copper", 2}, {"dillamore", 2}, {"rotated-cube", 1}};
  ASSERT_EQ(rolling_components().size(), variants.size());
  for (const auto& c : rolling_components())
    EXPECT_EQ(c.variants.size(), variants.at(c.name)) << c.name;
}

// The caption of fig. 18, S's second with the sign that the others show (docs/texture.md).
TEST(Components, LieWhereThePaperSays) {
  const std::map<std::string, std::vector<core::Vec3>> places{
      {"s",
       {{0.254, -0.235, -0.291},
        {-0.254, 0.235, -0.291},
        {-0.254, -0.235, 0.291},
        {0.254, 0.235, 0.291}}},
      {"brass", {{-0.414, -0.132, 0.318}, {0.414, 0.132, 0.318}}},
      {"copper", {{-0.132, -0.318, 0.414}, {0.132, 0.318, 0.414}}}};
  for (const auto& [name, list] : places)
    for (const auto& r : list) {
      double nearest = 1;
      for (const auto& v : named(name).variants)
        nearest = std::min(nearest, core::disorientation_angle(v, core::from_rodrigues(r)));
      EXPECT_LT(nearest, 0.2 * degree) << name << ' ' << r.transpose();
    }
}

TEST(Components, FractionsOfRandomOrientations) {
  core::Random random(5, core::Stream::tests);
  std::vector<Quaternion> q;
  for (int i = 0; i < 20000; ++i) q.push_back(random.rotation());
  const Sample sample = equally_weighted(q);
  for (const char* name : {"cube", "goss", "brass", "s"}) {
    const double share = random_volume_fraction(named(name), 15 * degree);
    EXPECT_NEAR(volume_fraction(sample, named(name), 15 * degree), share,
                4 * std::sqrt(share / 20000))
        << name;
  }
  EXPECT_NEAR(random_volume_fraction(named("cube"), 15 * degree), 0.0227, 1e-3);
}

TEST(Components, FractionsAndIntensitiesOfTheirOwn) {
  for (const auto& c : rolling_components()) {
    const Sample sample = equally_weighted(c.variants);
    EXPECT_DOUBLE_EQ(volume_fraction(sample, c, 15 * degree), 1) << c.name;
    const Odf odf(sample, 5 * degree);
    const double alone = odf.kernel().peak() / 24 / static_cast<double>(c.variants.size());
    EXPECT_NEAR(intensity(odf, c), alone, 1e-3 * alone) << c.name;
    const Quaternion away = core::exp_axial({0, 0, 16 * degree}) * c.variants[0];
    if (c.variants.size() > 2) continue;  // others of s are less than 16 degrees away
    EXPECT_EQ(volume_fraction(equally_weighted({away}), c, 15 * degree), 0) << c.name;
  }
}

TEST(BetaFibre, RunsFromCopperThroughSToBrass) {
  std::vector<Quaternion> all;
  for (const char* name : {"copper", "s", "brass"})
    all.insert(all.end(), named(name).variants.begin(), named(name).variants.end());
  const Odf odf(equally_weighted(all), 4 * degree);
  const auto fibre = beta_fibre(odf);
  ASSERT_EQ(fibre.size(), 10u);
  const auto distance = [](const core::Vec3& bunge, const char* name) {
    double nearest = 4;
    for (const auto& v : named(name).variants)
      nearest = std::min(nearest, core::disorientation_angle(v, core::from_bunge(bunge)));
    return nearest;
  };
  EXPECT_LT(distance(fibre.front().ideal, "copper"), 1e-6);
  EXPECT_LT(distance(fibre.back().ideal, "brass"), 1e-6);
  EXPECT_LT(distance(fibre[4].ideal, "s"), 2.5 * degree);  // phi2 = 65, s at 63.4
  for (const auto& p : fibre) {
    EXPECT_GE(p.ridge_intensity, p.ideal_intensity);
    EXPECT_LE((p.ridge - p.ideal).cwiseAbs().maxCoeff(), 17.6);
    EXPECT_EQ(p.ridge[2], p.phi2);
  }
  EXPECT_LT(distance(fibre.front().ridge, "copper"), 0.6 * degree);
  EXPECT_LT(distance(fibre.back().ridge, "brass"), 0.6 * degree);
  // Nothing lies half-way between copper and s, 9 degrees from both.
  EXPECT_GT(fibre.front().ridge_intensity, 3 * fibre[2].ideal_intensity);
}

}  // namespace
