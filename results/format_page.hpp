#pragma once
// docs/results-format.md, generated from the table of the state file.

#include <string>

namespace polyslip::results {

/// The page as a whole; a test compares it with the one in docs/.
std::string results_format_page();

}  // namespace polyslip::results
