#pragma once
// The files of `polyslip analyse`.

#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"

namespace polyslip::results::analysis {

struct FileOptions {
  bool overwrite = false;
  bool all_maps = false;    ///< sections of the ODF at every state; else of the last only
  std::vector<int> grains;  ///< whose paths and spreads are drawn, from 0; empty: the two largest
};

/// Names, relative to the folder, of earlier analyses there: texture.csv, spreads.csv and what lies
/// in analysis/ and is ours. Sorted.
std::vector<std::string> analysis_files(const std::string& folder);

/// InputError, one line, if the folder holds some and `overwrite` is false, or cannot be written
/// to.
void check_analysis_folder(const std::string& folder, bool overwrite);

/// Removes earlier ones and writes texture.csv, spreads.csv and analysis/ (docs/texture.md has the
/// list). Returns the names. InputError for a grain that is not there.
std::vector<std::string> write_analysis(const std::string& folder, const Analysis& analysis,
                                        const FileOptions& options);

/// "strain,component,intensity,volume_fraction" and rows.
std::string texture_csv(const Analysis& analysis);

}  // namespace polyslip::results::analysis
