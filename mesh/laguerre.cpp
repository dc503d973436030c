#include "mesh/laguerre.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/error.hpp"
#include "core/limited_memory.hpp"
#include "core/lognormal.hpp"
#include "core/random.hpp"
#include "mesh/volume_transport.hpp"

namespace polyslip::mesh {
namespace {

using core::Lognormal;
using core::Vec3;

constexpr double distribution_part = 12, outlier_part = 0.05;
constexpr double volume_tolerance = 1e-3;  // of a cell's target, while seeds move
constexpr double last_volume_tolerance = 1e-6;
constexpr double least_share = 0.02;  // of a cell's target volume, for a start of reach_volumes
constexpr double margin = 1e-3;       // distance of seeds from the domain's faces
constexpr int relaxations = 12;       // of Lloyd's kind, before the search
constexpr double relaxation = 0.7;    // share of the way to the centroid

double volume_of_diameter(double d) { return std::numbers::pi / 6 * d * d * d; }
double diameter_of_volume(double v) { return std::cbrt(6 * v / std::numbers::pi); }

void check_options(int grains, const GrainDistributions& o) {
  if (grains < 2) throw core::InputError("a Laguerre polycrystal needs two grains or more");
  if (!(o.diameter_deviation > 0 && o.diameter_deviation <= 1))
    throw core::InputError(fmt::format("diameter_deviation = {}: must be above 0 and at most 1",
                                       o.diameter_deviation));
  if (!(o.sphericity_mean > 0.5 && o.sphericity_mean < 0.95))
    throw core::InputError(
        fmt::format("sphericity_mean = {}: must be between 0.5 and 0.95", o.sphericity_mean));
  if (!(o.sphericity_deviation > 0 && o.sphericity_deviation <= 0.2))
    throw core::InputError(fmt::format("sphericity_deviation = {}: must be above 0 and at most 0.2",
                                       o.sphericity_deviation));
}

/// Asked distribution of diameters for which the mean volume is one.
Lognormal asked_diameters(double deviation) {
  const double third_moment = Lognormal(1, deviation).moment(3);
  const double mean = diameter_of_volume(1 / third_moment);
  return {mean, deviation * mean};
}

double middle_of_rank(std::size_t rank, std::size_t count) {
  return (static_cast<double>(rank) + 0.5) / static_cast<double>(count);
}

class Search {
 public:
  Search(int grains, const LaguerreOptions& options, const Domain& domain)
      : options_(options),
        domain_(domain),
        diameters_(asked_diameters(options.distributions.diameter_deviation)),
        lack_(1 - options.distributions.sphericity_mean,
              options.distributions.sphericity_deviation),
        random_(options.seed, core::Stream::seeds) {
    share_out_volumes(grains);
    scatter_seeds(grains);
  }

  PowerSeeds run(LaguerreReport& report, const std::function<void(double)>& progress) {
    for (int i = 0; i < relaxations; ++i) relax();
    auto cells = reach_volumes(seeds_, domain_, targets_, volume_tolerance);
    if (!cells)
      throw core::InputError(fmt::format(
          "no Laguerre tessellation with diameter_deviation = {} was found for {} grains: try "
          "another seed or a smaller deviation",
          options_.distributions.diameter_deviation, targets_.size()));
    core::LimitedMemoryOptions limits;
    limits.max_iterations = options_.max_iterations;
    PowerSeeds tried = seeds_;
    std::vector<PowerCell> tried_cells = *cells;
    core::minimise(
        unknowns(seeds_), [&](const Eigen::VectorXd& x) { return evaluate(x, tried, tried_cells); },
        [&] {
          seeds_ = tried;
          cells = tried_cells;
        },
        [&](int iteration) {
          report.iterations = iteration;
          if (progress) progress(static_cast<double>(iteration) / limits.max_iterations);
          return sphericity_distance(*cells) <= close_sphericity;
        },
        limits);
    if (auto exact = reach_volumes(seeds_, domain_, targets_, last_volume_tolerance))
      cells = std::move(exact);
    fill(report, *cells);
    if (progress) progress(1);
    return seeds_;
  }

 private:
  void share_out_volumes(int grains) {
    const auto n = static_cast<std::size_t>(grains);
    for (std::size_t i = 0; i < n; ++i)
      targets_.push_back(volume_of_diameter(diameters_.quantile(middle_of_rank(i, n))));
    for (std::size_t i = n - 1; i > 0; --i) std::swap(targets_[i], targets_[random_.index(i + 1)]);
    const double sum = std::accumulate(targets_.begin(), targets_.end(), 0.0);
    for (double& v : targets_) v *= domain_.volume / sum;
  }

  void scatter_seeds(int grains) {
    constexpr int patience = 10'000'000;  // points in a row outside the domain
    for (int i = 0; static_cast<int>(seeds_.positions.size()) < grains; ++i) {
      if (i == patience)
        throw core::InputError(
            "polycrystal: the domain has no room for seeds: it is too thin somewhere");
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = random_.uniform(0, domain_.size[k]);
      if (!domain_.contains(x, margin)) continue;
      seeds_.positions.push_back(x);
      i = 0;
    }
    seeds_.weights.assign(seeds_.positions.size(), 0);
  }

  void keep_inside(Vec3& x) const {
    for (const auto& f : domain_.faces)
      x -= std::max(0.0, f.plane.normal.dot(x) - (f.plane.offset - margin)) * f.plane.normal;
  }

  void relax() {
    auto cells = reach_volumes(seeds_, domain_, targets_, 0.3);
    if (!cells) {
      std::fill(seeds_.weights.begin(), seeds_.weights.end(), 0);
      cells = power_cells(seeds_, domain_);
    }
    for (std::size_t i = 0; i < cells->size(); ++i) {
      Vec3& x = seeds_.positions[i];
      if ((*cells)[i].volume > 0) x += relaxation * ((*cells)[i].centroid - x);
      keep_inside(x);
    }
    fill_empty_cells();
  }

  // Smaller weights are closer to a Voronoi tessellation, where no cell is empty.
  void fill_empty_cells() {
    constexpr int tries = 20;
    constexpr double factor = 0.7;
    for (int i = 0; i < tries; ++i) {
      const auto cells = power_cells(seeds_, domain_);
      bool full = true;
      for (std::size_t c = 0; c < cells.size(); ++c)
        full = full && cells[c].volume > least_share * targets_[c];
      if (full) return;
      for (double& w : seeds_.weights) w *= factor;
    }
    std::fill(seeds_.weights.begin(), seeds_.weights.end(), 0);
  }

  static Eigen::VectorXd unknowns(const PowerSeeds& seeds) {
    Eigen::VectorXd x(3 * seeds.positions.size());
    for (std::size_t i = 0; i < seeds.positions.size(); ++i)
      x.segment<3>(3 * static_cast<long>(i)) = seeds.positions[i];
    return x;
  }

  /// Starts from the weights of the last accepted point.
  std::optional<core::ValueAndGradient> evaluate(const Eigen::VectorXd& x, PowerSeeds& tried,
                                                 std::vector<PowerCell>& tried_cells) const {
    tried = seeds_;
    for (std::size_t i = 0; i < tried.positions.size(); ++i) {
      tried.positions[i] = x.segment<3>(3 * static_cast<long>(i));
      if (!domain_.contains(tried.positions[i], margin / 10)) return std::nullopt;
    }
    auto cells = reach_volumes(tried, domain_, targets_, volume_tolerance);
    if (!cells) return std::nullopt;
    tried_cells = std::move(*cells);
    std::vector<double> by_sphericity;
    const double value = misfit(tried_cells, by_sphericity);
    return core::ValueAndGradient{value, gradient(tried, tried_cells, by_sphericity)};
  }

  double misfit(const std::vector<PowerCell>& cells, std::vector<double>& derivative) const {
    const std::size_t n = cells.size();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < n; ++i) order.emplace_back(cells[i].sphericity(), i);
    std::sort(order.begin(), order.end());
    derivative.assign(n, 0);
    double sum = 0;
    const double count = static_cast<double>(n), sd = options_.distributions.sphericity_deviation;
    for (std::size_t k = 0; k < n; ++k) {
      const auto [s, i] = order[k];
      const double rank = middle_of_rank(k, n);
      const double apart = 1 - lack_.cdf(1 - s) - rank;
      const double beyond = (s - (1 - lack_.quantile(1 - rank))) / sd;
      sum += distribution_part * apart * apart + outlier_part * beyond * beyond;
      derivative[i] =
          2 * (distribution_part * apart * lack_.density(1 - s) + outlier_part * beyond / sd) /
          count;
    }
    return sum / count;
  }

  // At fixed volumes s_i = const / S_i, and weights follow the seeds:
  // dw = -H^-1 (dV/dx) dx, H = dV/dw.
  Eigen::VectorXd gradient(const PowerSeeds& seeds, const std::vector<PowerCell>& cells,
                           const std::vector<double>& by_sphericity) const {
    const std::size_t n = cells.size();
    std::vector<double> by_surface(n);
    for (std::size_t i = 0; i < n; ++i)
      by_surface[i] = -by_sphericity[i] * cells[i].sphericity() / cells[i].surface;
    const PowerGradient free = surface_gradient(cells, seeds, domain_, by_surface);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(
        volume_derivative(cells, seeds.positions));
    const Eigen::VectorXd multipliers =
        solver.solve(Eigen::Map<const Eigen::VectorXd>(free.weights.data(), static_cast<long>(n)));
    const std::vector<double> held = volume_gradient(
        cells, seeds, std::vector<double>(multipliers.data(), multipliers.data() + n));
    const auto size = static_cast<long>(3 * n);
    return Eigen::Map<const Eigen::VectorXd>(free.positions.data(), size) -
           Eigen::Map<const Eigen::VectorXd>(held.data(), size);
  }

  double sphericity_distance(const std::vector<PowerCell>& cells) const {
    std::vector<double> lacks;
    for (const auto& c : cells) lacks.push_back(1 - c.sphericity());
    return core::kolmogorov_smirnov(std::move(lacks), [this](double x) { return lack_.cdf(x); });
  }

  void fill(LaguerreReport& report, const std::vector<PowerCell>& cells) const {
    const auto moments = [&cells](const std::function<double(const PowerCell&)>& of, double& mean,
                                  double& deviation) {
      mean = deviation = 0;
      const double n = static_cast<double>(cells.size());
      for (const auto& c : cells) mean += of(c) / n;
      for (const auto& c : cells) deviation += (of(c) - mean) * (of(c) - mean) / n;
      deviation = std::sqrt(deviation);
    };
    const auto diameter = [](const PowerCell& c) { return diameter_of_volume(c.volume); };
    moments(diameter, report.diameter_mean, report.diameter_deviation);
    report.diameter_deviation /= report.diameter_mean;
    moments([](const PowerCell& c) { return c.sphericity(); }, report.sphericity_mean,
            report.sphericity_deviation);
    std::vector<double> diameters;
    for (const auto& c : cells) diameters.push_back(diameter(c));
    report.size_distance = core::kolmogorov_smirnov(std::move(diameters),
                                                    [this](double d) { return diameters_.cdf(d); });
    report.sphericity_distance = sphericity_distance(cells);
  }

  LaguerreOptions options_;
  const Domain& domain_;
  Lognormal diameters_, lack_;  ///< lack_: of one minus the sphericity
  core::Random random_;
  std::vector<double> targets_;
  PowerSeeds seeds_;
};

}  // namespace

PowerSeeds laguerre_seeds(int grains, const LaguerreOptions& options, const Domain& domain,
                          LaguerreReport& report, const std::function<void(double)>& progress) {
  check_options(grains, options.distributions);
  report = {};
  return Search(grains, options, domain).run(report, progress);
}

}  // namespace polyslip::mesh
