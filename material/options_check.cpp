#include "material/options_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace polyslip::material {

namespace {

void require(bool holds, const char* key, double value, const char* bounds) {
  if (holds && std::isfinite(value)) return;
  throw core::InputError(fmt::format("[material] {} = {}: must be {}", key, value, bounds));
}

}  // namespace

void check(const MaterialOptions& o) {
  require(o.c11 > std::abs(o.c12), "c11", o.c11, "finite and larger than |c12| (MPa)");
  require(o.c11 + 2 * o.c12 > 0, "c12", o.c12, "larger than -c11/2 (MPa)");
  require(o.c44 > 0, "c44", o.c44, "finite and positive (MPa)");
  require(o.reference_slip_rate > 0, "reference_slip_rate", o.reference_slip_rate,
          "finite and positive (1/s)");
  require(o.rate_sensitivity >= 0.003 && o.rate_sensitivity <= 1, "rate_sensitivity",
          o.rate_sensitivity, "between 0.003 and 1 (slip rate ~ |tau/g|^(1/m))");
  require(o.g0 > 0, "g0", o.g0, "finite and positive (MPa)");
  require(o.gs >= o.g0, "gs", o.gs, "finite and not below g0 (MPa)");
  require(o.h0 >= 0, "h0", o.h0, "finite and not negative (MPa)");
  require(o.voce_exponent >= 0.1 && o.voce_exponent <= 10, "voce_exponent", o.voce_exponent,
          "between 0.1 and 10");
  require(o.latent_ratio >= 0 && o.latent_ratio <= 5, "latent_ratio", o.latent_ratio,
          "between 0 and 5");
}

}  // namespace polyslip::material
