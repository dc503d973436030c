#pragma once
// report.html: one file that shows a run, with nothing from the network.

#include <string>

#include "results/report/data.hpp"

namespace polyslip::results::report {

struct ReportRequest {
  Sources sources = {};
  std::string page = {};  ///< the empty page that the build made
  bool overwrite = false;
};

/// Writes report.html into the run's folder, whole or not at all, and returns its path; the figures
/// as files go to figures/ beside it. An earlier report is replaced, any other file of that name
/// with `overwrite` only. InputError, one line, for a folder without results, a damaged file, or a
/// build without the page.
std::string write_report(const ReportRequest& request);

/// The page beside this very program.
std::string page_path();

}  // namespace polyslip::results::report
