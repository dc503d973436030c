#include "core/version.hpp"

namespace polyslip::core {

std::string version() { return POLYSLIP_VERSION; }

}  // namespace polyslip::core
