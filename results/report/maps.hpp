#pragma once
// The density maps of a texture: pole figures, inverse pole figures, sections.

#include <array>
#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/analysis/texture_maps.hpp"

namespace polyslip::results::report {

/// The ODF across phi2 = 45 (copper, {4 4 11}), 65 (S) and 90 degrees (brass, cube).
struct Sections {
  static constexpr std::array<double, 3> phi2{45, 65, 90};
  double step = 5;              ///< degrees
  int n1 = 0, n = 0;            ///< places of phi1 (up to 360, or 90 with sample symmetry), of Phi
  std::vector<double> density;  ///< [section][Phi][phi1]
};

struct StateMaps {
  std::array<analysis::DiscGrid, 3> poles;        ///< {111}, {200}, {220}
  std::array<analysis::TriangleGrid, 3> inverse;  ///< RD, TD, ND
  Sections sections;
  analysis::RodriguesSections rodrigues;
};

StateMaps maps_of(const analysis::Sample& sample, const analysis::AnalysisOptions& options);

/// Writes pole-figures-<strain>, inverse-pole-figures-<strain>, odf-sections-<strain> and
/// odf-rodrigues-<strain>, each .svg and .csv, and returns the names.
std::vector<std::string> write_maps(const std::string& folder, const StateMaps& maps,
                                    double strain);

}  // namespace polyslip::results::report
