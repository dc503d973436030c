// The keys of [material].

#include "drivers/options_sections.hpp"

namespace polyslip::drivers {

using core::Deck;

material::MaterialOptions read_material(Deck& deck) {
  auto t = deck.table(
      "material",
      "Elasto-viscoplastic FCC crystal with the 12 {111}<110> systems: slip rate = "
      "reference_slip_rate |tau/g|^(1/m) sign(tau), dg/dt = h0 ((gs - g)/(gs - "
      "g0))^voce_exponent times the sum of the slip rates' magnitudes, in which those of "
      "the other systems count latent_ratio. Defaults: the paper's aluminium.");
  material::MaterialOptions o;
  const auto modulus = [&](const char* key, double fallback, bool positive, const char* help) {
    return t.number(key, {.unit = "MPa",
                          .fallback = fallback,
                          .min = positive ? 0 : -core::unbounded,
                          .exclusive_min = true,
                          .help = help});
  };
  o.c11 = modulus("c11", o.c11, true, "Elastic constant C11; larger than c12.");
  o.c12 = modulus("c12", o.c12, false, "Elastic constant C12; larger than -c11/2.");
  o.c44 = modulus("c44", o.c44, true, "Elastic constant C44, half the modulus of tensor shear.");
  o.reference_slip_rate = t.number("reference_slip_rate", {.unit = "1/s",
                                                           .fallback = o.reference_slip_rate,
                                                           .min = 0,
                                                           .exclusive_min = true,
                                                           .help = "Slip rate at tau = g."});
  o.rate_sensitivity = t.number("rate_sensitivity",
                                {.fallback = o.rate_sensitivity,
                                 .min = 0.003,
                                 .max = 1,
                                 .help = "m: the exponent of |tau/g| is 1/m, so stress goes with "
                                         "the strain rate to the power m."});
  o.g0 = modulus("g0", o.g0, true, "Initial slip resistance.");
  o.gs = modulus("gs", o.gs, true,
                 "Slip resistance at saturation; larger than g0 (with h0 = 0 it "
                 "may be equal).");
  o.h0 = t.number("h0", {.unit = "MPa",
                         .fallback = o.h0,
                         .min = 0,
                         .help = "Initial hardening modulus; 0: no hardening."});
  o.voce_exponent = t.number("voce_exponent", {.fallback = o.voce_exponent,
                                               .min = 0.1,
                                               .max = 10,
                                               .help = "Exponent of (gs - g)/(gs - g0)."});
  o.latent_ratio = t.number(
      "latent_ratio",
      {.fallback = o.latent_ratio,
       .min = 0,
       .max = 5,
       .help =
           "Hardening of a system by slip on any other one, coplanar or not, over that by its "
           "own slip. 1: all systems share one g; else each of the 12 has a g of its own, g0 at "
           "first."});
  return o;
}

}  // namespace polyslip::drivers
