#pragma once
// What the regularisation of a polycrystal did to its grains, kept beside the tessellation: a .tess
// file says nothing of the cells that there were before.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace polyslip::results {

struct RegularisationRecord {
  int deletions = 0;                      ///< of edges
  int short_before = 0, short_after = 0;  ///< edges shorter than l_max
  double max_flatness_fault = 0;          ///< degrees
  /// Relative changes of the grains' volumes; `worst_grain`, from 1, is 0 if none changed.
  double volume_change_rms = 0, volume_change_worst = 0;
  int worst_grain = 0;
};

nlohmann::ordered_json to_json(const RegularisationRecord& record);

/// "regularisation.json" of a run folder. Errors as those of core::write_file.
void write_regularisation(const RegularisationRecord& record, const std::string& folder);
/// Nothing if the folder has none; InputError if it cannot be read.
std::optional<RegularisationRecord> read_regularisation(const std::string& folder);

}  // namespace polyslip::results
