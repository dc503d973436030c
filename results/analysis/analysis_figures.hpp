#pragma once
// The figures of `polyslip analyse` as SVG text.

#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/plot.hpp"

namespace polyslip::results::analysis {

/// Intensities and volume fractions of the components against strain.
std::vector<Plot> component_plots(const Analysis& analysis);
/// Intensity along the beta-fibre, a curve a strain (fig. 18 in one dimension).
std::vector<Plot> beta_plots(const Analysis& analysis);
/// Distribution of the grains' spreads at each strain (fig. 20).
std::vector<Plot> spread_plots(const Analysis& analysis);
/// A grain's spread at one strain against that at the strain before (fig. 21).
std::vector<Plot> correlation_plots(const Analysis& analysis);

/// Whether a state has a spread: not the undeformed ones.
bool has_spread(const Analysis& analysis, std::size_t state);

}  // namespace polyslip::results::analysis
