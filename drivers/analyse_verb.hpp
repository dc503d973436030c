#pragma once
// `polyslip analyse`: texture and microtexture of a run, a Taylor model or a file of orientations.

#include <optional>
#include <string>
#include <vector>

namespace polyslip::drivers {

struct AnalyseRequest {
  std::string input;       ///< folder of a run or Taylor model, or file of orientations
  std::string to;          ///< folder for the files; empty: the folder itself, or <file>-analysis
  std::string convention;  ///< of a file: as [orientations] convention; empty: by its extension
  std::optional<double> half_width;            ///< degrees; default: the deck's, else 10
  std::optional<std::string> sample_symmetry;  ///< default: the deck's, else none
  bool inner = false, one_mode = false, all_maps = false, overwrite = false;
  std::vector<double> at_strains;
  std::vector<int> grains;  ///< to draw, from 1
  int threads = 0;          ///< 0: one a core
};

struct CompareRequest {
  std::string run, taylor;  ///< folders
  std::string to;           ///< folder for the files; empty: the run's
  AnalyseRequest how;       ///< half-width, symmetry, inner, strains, threads, overwrite
};

/// Puts a run and the Taylor model of its deck side by side: files in analysis/ and a table.
/// InputError as results/analysis/compare.hpp says.
void compare(const CompareRequest& request);

/// Writes the files and prints the components' table. InputError for an input that is not there or
/// is neither, and as results/analysis says.
void analyse(const AnalyseRequest& request);

}  // namespace polyslip::drivers
