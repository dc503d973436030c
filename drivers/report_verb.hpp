#pragma once
// `polyslip report`: a run in one HTML file.

#include <string>

#include "drivers/options.hpp"

namespace polyslip::drivers {

struct ReportRequest {
  std::string folder = {};  ///< of the run
  std::string taylor = {};  ///< of a Taylor model to show beside it; empty: none
  bool overwrite = false;   ///< a report.html that is none of ours
};

/// Writes report.html and figures/ and returns the report's path; densities as the run's deck says
/// in [texture]. InputError as results::report::write_report.
std::string write_report(const ReportRequest& request);

/// The same at the end of a run, of whose deck `texture` is.
std::string write_report(const ReportRequest& request, const TextureOptions& texture);

}  // namespace polyslip::drivers
