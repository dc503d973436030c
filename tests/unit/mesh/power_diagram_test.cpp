#include "mesh/power_diagram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "mesh/volume_transport.hpp"

namespace {

using polyslip::core::Vec3;
using polyslip::mesh::box_domain;
using polyslip::mesh::Domain;
using polyslip::mesh::power_cells;
using polyslip::mesh::PowerSeeds;

PowerSeeds some_seeds(int count, const Domain& domain) {
  polyslip::core::Random random(7, polyslip::core::Stream::tests);
  PowerSeeds seeds;
  for (int i = 0; i < count; ++i) {
    seeds.positions.push_back(
        Vec3(random.uniform(0.01, 0.99), random.uniform(0.01, 0.99), random.uniform(0.01, 0.99))
            .cwiseProduct(domain.size));
    seeds.weights.push_back(random.uniform(0, 0.05));
  }
  return seeds;
}

double weighted(const PowerSeeds& seeds, const Domain& domain, const std::vector<double>& g,
                bool surface) {
  double sum = 0;
  const auto cells = power_cells(seeds, domain);
  for (std::size_t i = 0; i < cells.size(); ++i)
    sum += g[i] * (surface ? cells[i].surface : cells[i].volume);
  return sum;
}

std::vector<double> factors(std::size_t n) {
  std::vector<double> g;
  for (std::size_t i = 0; i < n; ++i) g.push_back(std::sin(1.0 + 2.0 * static_cast<double>(i)));
  return g;
}

TEST(PowerDiagram, OfACubeIsTheCube) {
  const auto cells = power_cells({{{0.3, 0.4, 0.5}}, {0.2}}, box_domain({1, 1, 1}));
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_NEAR(cells[0].volume, 1, 1e-14);
  EXPECT_NEAR(cells[0].surface, 6, 1e-13);
  EXPECT_NEAR((cells[0].centroid - Vec3(0.5, 0.5, 0.5)).norm(), 0, 1e-14);
  EXPECT_NEAR(cells[0].sphericity(), std::cbrt(std::numbers::pi / 6), 1e-13);
}

TEST(PowerDiagram, WeightsMoveThePlaneBetweenTwoCells) {
  // The plane between seeds d apart lies (w0 - w1) / (2 d) beyond the middle.
  const auto cells =
      power_cells({{{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}}, {0.3, 0.1}}, box_domain({2, 1, 1}));
  EXPECT_NEAR(cells[0].volume, 1.1, 1e-13);
  EXPECT_NEAR(cells[1].volume, 0.9, 1e-13);
}

TEST(PowerDiagram, DerivativesAreThoseOfDifferences) {
  const Domain domain = box_domain({2, 3, 2.5});
  const PowerSeeds seeds = some_seeds(25, domain);
  const auto cells = power_cells(seeds, domain);
  const auto g = factors(cells.size());
  const auto of_surface = surface_gradient(cells, seeds, domain, g);
  const auto of_volume = volume_gradient(cells, seeds, g);
  const auto derivative = volume_derivative(cells, seeds.positions);
  const double h = 1e-6;
  const auto difference = [&](bool surface, const auto& change) {
    PowerSeeds up = seeds, down = seeds;
    change(up, h), change(down, -h);
    return (weighted(up, domain, g, surface) - weighted(down, domain, g, surface)) / (2 * h);
  };
  double largest = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto move = [i, k](PowerSeeds& s, double by) { s.positions[i][k] += by; };
      EXPECT_NEAR(of_surface.positions[3 * i + k], difference(true, move), 1e-6);
      EXPECT_NEAR(of_volume[3 * i + k], difference(false, move), 1e-6);
      largest = std::max(largest, std::abs(of_surface.positions[3 * i + k]));
    }
    const auto weigh = [i](PowerSeeds& s, double by) { s.weights[i] += by; };
    EXPECT_NEAR(of_surface.weights[i], difference(true, weigh), 1e-6);
    double column = 0;
    for (std::size_t j = 0; j < g.size(); ++j)
      column += g[j] * derivative.coeff(static_cast<int>(j), static_cast<int>(i));
    EXPECT_NEAR(column, difference(false, weigh), 1e-6);
  }
  EXPECT_GT(largest, 0.1);
}

TEST(VolumeTransport, GivesEachCellItsVolume) {
  const Domain domain = box_domain({2, 3, 2.5});
  PowerSeeds seeds = some_seeds(40, domain);
  seeds.weights.assign(40, 0);
  std::vector<double> targets;
  double sum = 0;
  for (int i = 0; i < 40; ++i) sum += targets.emplace_back(1 + i % 7);
  for (double& t : targets) t *= domain.volume / sum;
  const auto cells = reach_volumes(seeds, domain, targets, 1e-9);
  ASSERT_TRUE(cells.has_value());
  for (std::size_t i = 0; i < targets.size(); ++i)
    EXPECT_NEAR((*cells)[i].volume, targets[i], 1e-9 * targets[i]);
}

TEST(VolumeTransport, LeavesSeedsOfEmptyCellsAlone) {
  const Domain domain = box_domain({1, 1, 1});
  PowerSeeds seeds{{{0.5, 0.5, 0.5}, {0.501, 0.5, 0.5}}, {1, 0}};
  EXPECT_FALSE(reach_volumes(seeds, domain, {0.5, 0.5}, 1e-6).has_value());
  EXPECT_EQ(seeds.weights[0], 1);
}

}  // namespace
