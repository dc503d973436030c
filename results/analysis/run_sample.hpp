#pragma once
// The orientations of a stored state, of a run or of a Taylor model.

#include <string>
#include <vector>

#include "results/analysis/sample.hpp"
#include "results/state_series.hpp"

namespace polyslip::results::analysis {

/// Element means and volumes of a state; of a Taylor model its orientations, alike in weight.
struct RunSample {
  double strain = 0;
  bool meshed = true;       ///< false: orientations of a Taylor model, a grain each
  Sample sample;            ///< a row an element
  std::vector<int> grain;   ///< of each element, from 0
  std::vector<bool> inner;  ///< of each grain: without a face on the domain boundary

  int grains() const { return static_cast<int>(inner.size()); }
};

/// InputError as read_state. Reads only what is needed here.
RunSample read_run_sample(const std::string& path);

/// The elements of grains for which keep[grain] holds. InternalError if none is left.
Sample of_grains(const RunSample& sample, const std::vector<bool>& keep);

/// The stored states to look at, in order of strain: of two at one strain (both sides of a
/// remeshing) the first; all of them, or the nearest to each of `strains`, each once.
/// InputError if the folder has none, or none within 0.01 of a strain.
std::vector<StateRecord> chosen_states(const StateSeries& series,
                                       const std::vector<double>& strains);

}  // namespace polyslip::results::analysis
