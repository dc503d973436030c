#pragma once
// A stored state without a mesh: orientations side by side, as the Taylor model has them. The same
// datasets as a state file where they apply, in a file sealed the same way.

#include <string>
#include <vector>

#include "results/element_values.hpp"

namespace polyslip::results {

inline const std::string orientation_file_type = "polyslip-orientations";
inline constexpr int orientation_file_version = 1;

struct OrientationState {
  double time = 0;    ///< s
  double strain = 0;  ///< path of the load
  /// A row an orientation; volumes are their weights, centroids are not there (NaN).
  ElementTable table;
};

/// Writes `path` + ".part", adds the checksum and renames. InputError if that is impossible.
void write_orientation_state(const std::string& path, const OrientationState& state);

/// What was written. InputError, one line, for a file that is missing, damaged or of another type.
OrientationState read_orientation_state(const std::string& path);

/// Whether a whole file is of this type (and not a state with a mesh). InputError as above.
bool holds_orientations_only(const std::string& path);

}  // namespace polyslip::results
