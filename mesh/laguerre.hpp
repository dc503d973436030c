#pragma once
// Laguerre polycrystals with asked distributions of grain size and sphericity.

#include <cstdint>
#include <functional>

#include "mesh/power_diagram.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

struct LaguerreOptions {
  std::uint64_t seed = 1;
  GrainDistributions distributions{};
  int max_iterations = 150;
};

struct LaguerreReport {
  /// Kolmogorov-Smirnov distances to what was asked, over all cells.
  double size_distance = 0, sphericity_distance = 0;
  double diameter_mean = 0, diameter_deviation = 0;  ///< reached; standard deviation over mean
  double sphericity_mean = 0, sphericity_deviation = 0;
  int iterations = 0;
};

/// Sphericity distances at which the search ends. Below about 0.03 it does not fall for 1,000
/// grains: the grains at the domain's faces and the smallest ones keep it up.
inline constexpr double close_sphericity = 0.03;

/// Seeds and weights of `grains` cells that fill the domain, whose volume is the number of grains.
///
/// The volumes are the quantiles of the asked distribution, shared out at random: weights that give
/// them exist for any seeds (reach_volumes). The seeds are then moved, at fixed volumes, so that
/// the sorted sphericities come close to their quantiles q_k: minimised is the mean over cells of
///   c [F(s_k) - (k - 1/2)/n]^2 + d [(s_k - q_k)/sd]^2,
/// F: the asked distribution function, c = 12 and d = 0.05 (the second part pulls on far outliers,
/// where F is flat). Its gradient by the seeds at fixed volumes takes one linear system with
/// volume_derivative. InputError for options out of range. Same seed, same result with the same
/// mathematical library (logarithms and exponentials round differently between them).
PowerSeeds laguerre_seeds(int grains, const LaguerreOptions& options, const Domain& domain,
                          LaguerreReport& report,
                          const std::function<void(double fraction)>& progress = {});

}  // namespace polyslip::mesh
