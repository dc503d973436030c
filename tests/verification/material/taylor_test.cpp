// Random FCC polycrystal under full constraints: sigma_vM/g at a von Mises rate of gammadot0, for
// initial orientations. The published limits are Taylor's 3.0667 (tension) and 2.8788 (plane
// strain); m = 1 has the closed form 33/20. 5,000 spread orientations are converged to 1e-3 (test
// below), the table to 1e-3, at 0.12 to 4e-3.

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "crystals.hpp"

namespace {

using namespace polyslip;

/// Stress work per unit of von Mises strain and g, for the rate scaled to unit von Mises rate.
double taylor_stress(double m, const core::Mat3& rate,
                     const std::vector<core::Quaternion>& orientations) {
  const core::Mat3 unit = rate / core::equivalent_strain(rate);
  const auto law = material::make_fcc_law(material::test::rigid_ideal(m));
  material::PointDriver driver(*law, orientations);
  for (int step = 0; step < 2; ++step) {
    if (driver.advance(unit, 1e-5) != 0) return std::nan("");
  }
  return core::mandel(unit).dot(driver.mean_stress());
}

struct Row {
  double m, tension, plane_strain, tolerance;
};

TEST(Taylor, StressOfARandomPolycrystalAtEverySensitivity) {
  const auto orientations = material::spread_orientations(5000);
  const Row rows[] = {{1.0, 1.65, 1.65, 1e-3},    {0.2, 2.767, 2.681, 2e-3},
                      {0.12, 2.881, 2.756, 4e-3}, {0.1, 2.910, 2.774, 2e-3},
                      {0.05, 2.986, 2.824, 2e-3}, {0.02, 3.034, 2.856, 2e-3},
                      {0.01, 3.050, 2.867, 2e-3}};
  for (const auto& row : rows) {
    const double tension = taylor_stress(row.m, material::test::tension_z(), orientations);
    const double plane = taylor_stress(row.m, material::test::plane_strain(), orientations);
    EXPECT_NEAR(tension, row.tension, row.tolerance) << row.m;
    EXPECT_NEAR(plane, row.plane_strain, row.tolerance) << row.m;
    std::printf("m = %.2f: tension %.4f, plane strain %.4f\n", row.m, tension, plane);
  }
}

TEST(Taylor, SpreadOrientationsAreConverged) {
  for (const auto& rate : {material::test::tension_z(), material::test::plane_strain()}) {
    const double coarse = taylor_stress(0.05, rate, material::spread_orientations(5000));
    const double fine = taylor_stress(0.05, rate, material::spread_orientations(40000));
    EXPECT_NEAR(coarse, fine, 1e-3);
  }
}

TEST(Taylor, RandomOrientationsAgree) {
  core::Random random(3, core::Stream::orientations);
  std::vector<core::Quaternion> orientations;
  for (int i = 0; i < 25000; ++i) orientations.push_back(random.rotation());
  // three standard errors of a scatter of 0.40 and 0.52
  EXPECT_NEAR(taylor_stress(0.05, material::test::tension_z(), orientations), 2.986, 0.01);
  EXPECT_NEAR(taylor_stress(0.05, material::test::plane_strain(), orientations), 2.824, 0.01);
}

TEST(Taylor, StressScalesWithRateAndStrength) {
  auto options = material::test::rigid_ideal(0.12);
  options.g0 = options.gs = 3.0;
  options.reference_slip_rate = 0.5;
  const auto law = material::make_fcc_law(options);
  const auto orientations = material::spread_orientations(500);
  material::PointDriver driver(*law, orientations);
  const core::Mat3 unit = material::test::plane_strain() / std::sqrt(4.0 / 3);
  for (int step = 0; step < 2; ++step) ASSERT_EQ(driver.advance(unit, 1e-5), 0);
  const double expected =
      taylor_stress(0.12, material::test::plane_strain(), orientations) * 3.0 * std::pow(2.0, 0.12);
  EXPECT_NEAR(core::mandel(unit).dot(driver.mean_stress()), expected, 1e-4 * expected);
}

}  // namespace
