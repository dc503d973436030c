#pragma once
// macro.csv read back: columns of numbers by name.

#include <string>
#include <vector>

namespace polyslip::results::report {

struct MacroTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< [name][step]

  std::size_t steps() const { return columns.empty() ? 0 : columns.front().size(); }
  /// InternalError for a name that the file does not have.
  const std::vector<double>& column(const std::string& name) const;
};

/// The whole lines of the file: the torn one of a killed run is left out. InputError if there is no
/// such file or a line is not as many numbers as there are names.
MacroTable read_macro(const std::string& path);

}  // namespace polyslip::results::report
