#pragma once
// A run beside the Taylor model of the same deck (fig. 18 of the paper).

#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"

namespace polyslip::results::analysis {

struct Comparison {
  Analysis run, taylor;  ///< of the strains at which both have stored a state, index for index
};

/// Strains (those of `asked`, or all if empty) at which both folders have a state, to 1e-3.
/// InputError if there are none.
std::vector<double> common_strains(const std::string& run, const std::string& taylor,
                                   const std::vector<double>& asked);

/// InputError as analyse_folder; `options.at_strains` picks among the common strains.
Comparison compare_folders(const std::string& run, const std::string& taylor,
                           AnalysisOptions options);

/// strain,component,intensity_run,intensity_taylor,volume_fraction_run,volume_fraction_taylor
std::string comparison_csv(const Comparison& comparison);

/// Writes compare.csv and the figures compare-*.svg into `folder`/analysis: components and the
/// beta-fibre, pole figures and Rodrigues sections at the last common strain, and the curves of
/// both macro.csv. Returns the names. InputError if compare.csv is there and `overwrite` is false.
std::vector<std::string> write_comparison(const std::string& folder, const Comparison& comparison,
                                          const std::string& run, const std::string& taylor,
                                          bool overwrite);

/// InputError, one line, if `folder` holds an earlier comparison and `overwrite` is false.
void check_comparison_place(const std::string& folder, bool overwrite);

}  // namespace polyslip::results::analysis
