#pragma once
// Bounds of the material options.

#include "material/crystal_law.hpp"

namespace polyslip::material {

/// Throws core::InputError, one line that names the option, its value and its bounds, unless the
/// options describe a stable crystal (c11 > |c12|, c44 > 0), 0.003 <= m <= 1, reference_slip_rate >
/// 0, g0 > 0, gs >= g0, h0 >= 0, 0.1 <= voce_exponent <= 10 and 0 <= latent_ratio <= 5, all finite.
void check(const MaterialOptions& options);

}  // namespace polyslip::material
