#pragma once
// The figures of a report as files for papers: SVG, and the numbers as CSV.

#include <string>
#include <vector>

#include "results/report/data.hpp"

namespace polyslip::results::report {

/// Replaces the files that docs/report.md lists in `folder`, which is made if it is not there.
/// Returns the names. InputError if that is impossible.
std::vector<std::string> write_figures(const std::string& folder, const ReportData& data);

}  // namespace polyslip::results::report
