#pragma once
// report.html: one file that shows a run, with nothing from the network.

#include <string>

namespace polyslip::results::report {

struct ReportRequest {
  std::string folder;  ///< of the run
  std::string page;    ///< the empty page that the build made
  bool overwrite = false;
};

/// Writes folder/report.html, whole or not at all, and returns its path. An earlier report is
/// replaced, any other file of that name with `overwrite` only. InputError, one line, for a folder
/// without results, a damaged file, or a build without the page.
std::string write_report(const ReportRequest& request);

/// The page beside this very program.
std::string page_path();

}  // namespace polyslip::results::report
