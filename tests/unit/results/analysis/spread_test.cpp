// Spreads within grains: closed forms and definitions.

#include "results/analysis/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/rotation.hpp"

namespace {

using namespace polyslip;
using namespace polyslip::results::analysis;
using core::Quaternion;
using core::Vec3;

constexpr double degree = std::numbers::pi / 180;

RunSample one_grain(Sample sample) {
  RunSample s;
  s.grain.assign(sample.size(), 0);
  s.inner = {true};
  s.sample = std::move(sample);
  return s;
}

/// Rotations of `centre` by normal vectors of this deviation [degrees] about each axis.
Sample normal_spread(const Quaternion& centre, double deviation, int count) {
  core::Random random(11, core::Stream::tests);
  Sample s;
  for (int i = 0; i < count; ++i) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    s.orientations.push_back(core::exp_axial(deviation * degree * Vec3(x, y, z)) * centre *
                             core::cubic_symmetries()[i % 24]);
    s.weights.push_back(1);
  }
  return s;
}

TEST(Spread, OfTwoHalvesIsHalfTheirAngle) {
  const Quaternion q = core::from_bunge({40, 60, 20}), turn = core::exp_axial({0, 0, 4 * degree});
  // 1 : 3 by volume: the mean is turned by 3 of the 4 degrees (for small angles).
  const auto g = grain_spreads(one_grain({{q, turn * q}, {1, 3}}), {}, {}).front();
  EXPECT_NEAR(g.spread, (1 * 3.0 + 3 * 1.0) / 4, 2e-3);
  EXPECT_NEAR(g.largest, 3, 2e-3);
  EXPECT_NEAR(g.deviation, std::sqrt((9.0 + 3) / 4 - 2.25), 2e-3);
  EXPECT_EQ(g.elements, 2);
  EXPECT_EQ(g.volume, 4);
}

// The mean length of a normal vector in three dimensions is sqrt(8/pi) deviations. The variants of
// the crystals must not matter.
TEST(Spread, OfNormalVectors) {
  const Quaternion centre = core::from_bunge({200, 70, 75});
  const auto g = grain_spreads(one_grain(normal_spread(centre, 3, 20000)), {}, {}).front();
  EXPECT_NEAR(g.spread, 3 * std::sqrt(8 / std::numbers::pi), 0.05);
  EXPECT_LT(core::disorientation_angle(g.mean, centre), 0.1 * degree);
  EXPECT_NEAR(g.bimodality, 1.0 / 3, 0.02);
  EXPECT_LT(g.bimodality, one_mode_bound);
  const Vec3 r = core::to_rodrigues(g.mean);
  EXPECT_LE(r.cwiseAbs().maxCoeff(), std::numbers::sqrt2 - 1 + 1e-12);  // fundamental at first
}

TEST(Spread, IsContinuousFromStateToState) {
  const Quaternion centre = core::from_bunge({200, 70, 75});
  const auto first = grain_spreads(one_grain(normal_spread(centre, 0.01, 200)), {}, {});
  auto before = first;
  for (int step = 1; step <= 12; ++step) {  // 84 degrees in all, far out of the region
    const Quaternion now = core::exp_axial({7.0 * step * degree, 0, 0}) * centre;
    const auto next = grain_spreads(one_grain(normal_spread(now, 0.01, 200)), before, first);
    EXPECT_NEAR(next.front().rotation, 7.0 * step, 0.05);
    before = next;
  }
}

TEST(Spread, TwoModesAreToldFromOne) {
  const Quaternion q = core::from_bunge({10, 20, 30});
  Sample both = normal_spread(q, 1, 1000);
  const Sample other = normal_spread(core::exp_axial({0, 10 * degree, 0}) * q, 1, 1000);
  both.orientations.insert(both.orientations.end(), other.orientations.begin(),
                           other.orientations.end());
  both.weights.insert(both.weights.end(), other.weights.begin(), other.weights.end());
  EXPECT_GT(grain_spreads(one_grain(both), {}, {}).front().bimodality, 0.8);
  // Closed forms: two places 1, uniform 5/9.
  EXPECT_NEAR(bimodality({{-1, 0, 0}, {1, 0, 0}}, {1, 1}), 1, 1e-12);
  std::vector<Vec3> line;
  for (int i = 0; i < 1000; ++i) line.emplace_back(0, i / 1000.0, 0);
  EXPECT_NEAR(bimodality(line, std::vector<double>(line.size(), 2.0)), 5.0 / 9, 1e-4);
  EXPECT_EQ(bimodality({{1, 2, 3}}, {1}), 0);
}

TEST(Spread, OfOneElementIsNothing) {
  const auto g = grain_spreads(one_grain({{core::from_bunge({10, 20, 30})}, {2}}), {}, {}).front();
  EXPECT_LT(g.spread, 1e-9);
  EXPECT_EQ(g.bimodality, 0);
}

TEST(Spread, RefusesAGrainWithoutElements) {
  RunSample s = one_grain({{Quaternion::Identity()}, {1}});
  s.inner = {true, true};
  EXPECT_THROW(grain_spreads(s, {}, {}), core::InternalError);
}

TEST(Correlation, ClosedForms) {
  EXPECT_NEAR(correlation({1, 2, 3}, {5, 7, 9}), 1, 1e-12);
  EXPECT_NEAR(correlation({1, 2, 3}, {3, 2, 1}), -1, 1e-12);
  EXPECT_NEAR(correlation({1, 2, 3, 4}, {1, -1, -1, 1}), 0, 1e-12);
  EXPECT_TRUE(std::isnan(correlation({1}, {2})));
  EXPECT_TRUE(std::isnan(correlation({1, 1}, {2, 3})));
}

}  // namespace
