#pragma once
// What was built.

#include <string>

namespace polyslip::core {

/// Version of the project, and the commit it was configured at if that was known:
/// "0.1.0" or "0.1.0 (4a2ec37)", with "-dirty" inside for a changed tree.
std::string version();

}  // namespace polyslip::core
