#pragma once
// `polyslip stats`: the statistics of a tessellation, a mesh, or a folder that holds both.

#include <optional>
#include <string>

namespace polyslip::drivers {

struct StatsRequest {
  std::string input;                   ///< .tess or .msh file, .gz too, or a folder of ours
  std::string to;                      ///< folder for the files; empty: only the table
  bool inner = false;                  ///< grains without a face on the domain boundary only
  std::optional<double> element_size;  ///< c_l of eq. (7), for grains of unit mean volume
  bool overwrite = false;
};

/// Prints the table and writes the files. Of a folder the tessellation polycrystal.tess and the
/// first mesh mesh-000.msh are read, what there is of them, and c_l from its deck. InputError for
/// an input that is not there or is neither, and as check_statistics_folder.
void print_statistics(const StatsRequest& request);

}  // namespace polyslip::drivers
