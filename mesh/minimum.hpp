#pragma once
// Minimum of numbers of which one may be none.

#include <cmath>

namespace polyslip::mesh {

/// The lesser of two numbers; NaN if one of them is NaN (std::min may drop it).
inline double min_or_nan(double a, double b) { return a < b || std::isnan(a) ? a : b; }

}  // namespace polyslip::mesh
