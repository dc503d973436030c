// Laguerre polycrystals against the distributions that are asked for: Kolmogorov-Smirnov distance
// at most 0.02 for sizes and 0.05 for sphericities, over all grains.

#include "mesh/laguerre.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/lognormal.hpp"
#include "mesh/tessellation.hpp"

namespace {

using namespace polyslip;

void expect_distributions(int grains, const mesh::LaguerreOptions& options) {
  const mesh::Domain domain = mesh::box_domain(core::Vec3::Constant(std::cbrt(grains)));
  mesh::LaguerreReport report;
  const auto seeds = mesh::laguerre_seeds(grains, options, domain, report);
  // Measured afresh, not read from the report.
  std::vector<double> diameters, lacks;
  for (const auto& cell : mesh::power_cells(seeds, domain)) {
    diameters.push_back(std::cbrt(6 * cell.volume / M_PI));
    lacks.push_back(1 - cell.sphericity());
  }
  ASSERT_EQ(static_cast<int>(diameters.size()), grains);
  double mean = 0;
  for (const double d : diameters) mean += d / grains;
  const core::Lognormal size(mean, options.distributions.diameter_deviation * mean);
  const core::Lognormal lack(1 - options.distributions.sphericity_mean,
                             options.distributions.sphericity_deviation);
  EXPECT_LE(core::kolmogorov_smirnov(diameters, [&](double x) { return size.cdf(x); }), 0.02);
  const double distance = core::kolmogorov_smirnov(lacks, [&](double x) { return lack.cdf(x); });
  EXPECT_LE(distance, 0.05);
  EXPECT_NEAR(report.sphericity_distance, distance, 1e-12);
  EXPECT_NEAR(report.diameter_deviation, options.distributions.diameter_deviation, 0.01);
}

TEST(Laguerre, ReachesNormalGrainGrowth) {
  expect_distributions(1000, {.seed = 1, .distributions = {}});
}

TEST(Laguerre, ReachesNarrowSizes) {
  expect_distributions(1000, {.seed = 2,
                              .distributions = {.diameter_deviation = 0.15,
                                                .sphericity_mean = 0.87,
                                                .sphericity_deviation = 0.025}});
}

TEST(Laguerre, TessellationIsRegularisedLikeAnyOther) {
  const mesh::Domain domain = mesh::box_domain({4, 4, 4});
  mesh::LaguerreReport report;
  const auto seeds = mesh::laguerre_seeds(
      64, {.seed = 3, .distributions = {}, .max_iterations = 20}, domain, report);
  auto t = mesh::laguerre_tessellation(seeds.positions, seeds.weights, domain);
  t.check();
  const auto cells = mesh::power_cells(seeds, domain);
  for (int c = 0; c < 64; ++c) EXPECT_NEAR(mesh::cell_volume(t, c), cells[c].volume, 1e-9);
  const auto edges = t.topology.edges.size();
  mesh::regularise(t, {});
  t.check();
  EXPECT_LT(t.topology.edges.size(), edges);
}

TEST(Laguerre, SameSeedSamePolycrystal) {
  const mesh::Domain domain = mesh::box_domain({3, 3, 3});
  mesh::LaguerreReport report;
  const mesh::LaguerreOptions options{.seed = 5, .distributions = {}, .max_iterations = 10};
  const auto a = mesh::laguerre_seeds(27, options, domain, report);
  const auto b = mesh::laguerre_seeds(27, options, domain, report);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_EQ(a.positions, b.positions);
}

TEST(Laguerre, RefusesWhatCannotBe) {
  const mesh::Domain domain = mesh::box_domain({1, 1, 1});
  mesh::LaguerreReport report;
  EXPECT_THROW(mesh::laguerre_seeds(1, {}, domain, report), core::InputError);
  EXPECT_THROW(
      mesh::laguerre_seeds(8, {.distributions = {.diameter_deviation = 0}}, domain, report),
      core::InputError);
  EXPECT_THROW(mesh::laguerre_seeds(8, {.distributions = {.sphericity_mean = 1}}, domain, report),
               core::InputError);
}

}  // namespace
