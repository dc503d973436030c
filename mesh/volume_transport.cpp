#include "mesh/volume_transport.hpp"

#include <algorithm>
#include <cmath>

namespace polyslip::mesh {
namespace {

constexpr int max_iterations = 60;
constexpr int max_halvings = 25;

struct Deviation {
  double least_share = 0;  ///< least volume over its target
  double largest = 0;      ///< largest |volume/target - 1|
  Eigen::VectorXd lacking;
};

Deviation deviation(const std::vector<PowerCell>& cells, const std::vector<double>& targets) {
  Deviation d{cells.empty() ? 0 : HUGE_VAL, 0, Eigen::VectorXd(cells.size())};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double share = cells[i].volume / targets[i];
    d.least_share = std::min(d.least_share, share);
    d.largest = std::max(d.largest, std::abs(share - 1));
    d.lacking[static_cast<long>(i)] = targets[i] - cells[i].volume;
  }
  return d;
}

}  // namespace

Eigen::SparseMatrix<double> volume_derivative(const std::vector<PowerCell>& cells,
                                              const std::vector<core::Vec3>& seeds) {
  // Far above rounding and far below the diagonal: makes the matrix regular.
  constexpr double regular = 1e-9;
  const int n = static_cast<int>(cells.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    double diagonal = 0;
    for (const auto& facet : cells[i].facets) {
      const int j = facet.neighbour;
      if (j < 0) continue;
      const double part = facet.area / (2 * (seeds[i] - seeds[j]).norm());
      diagonal += part;
      entries.emplace_back(i, j, -part);
    }
    entries.emplace_back(i, i, diagonal * (1 + regular) + 1e-3 * regular);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::optional<std::vector<PowerCell>> reach_volumes(PowerSeeds& seeds, const Domain& domain,
                                                    const std::vector<double>& targets,
                                                    double tolerance) {
  PowerSeeds trial = seeds;
  auto cells = power_cells(trial, domain);
  Deviation now = deviation(cells, targets);
  const double least_share = 0.5 * std::min(1.0, now.least_share);
  if (!(least_share > 0)) return std::nullopt;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (now.largest <= tolerance) {
      seeds = std::move(trial);
      return cells;
    }
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(
        volume_derivative(cells, trial.positions));
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd change = solver.solve(now.lacking);
    bool accepted = false;
    double step = 1;
    for (int i = 0; i < max_halvings && !accepted; ++i, step /= 2) {
      PowerSeeds next = trial;
      for (std::size_t c = 0; c < targets.size(); ++c)
        next.weights[c] += step * change[static_cast<long>(c)];
      auto next_cells = power_cells(next, domain);
      Deviation then = deviation(next_cells, targets);
      if (!(then.least_share >= least_share &&
            then.lacking.norm() <= (1 - step / 2) * now.lacking.norm()))
        continue;
      trial = std::move(next);
      cells = std::move(next_cells);
      now = std::move(then);
      accepted = true;
    }
    if (!accepted) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace polyslip::mesh
