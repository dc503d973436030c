#pragma once
// Voce's hardening over a step (docs/theory-material.md, (M.9)). Private to material.

#include "material/vector_math.hpp"

namespace polyslip::material::simd {

/// Constants of g' = h0 Y^exponent times a rate of slip, Y = (gs - g)/(gs - g0).
struct VoceConstants {
  double rate = 0;      ///< k = h0/(gs - g0) [1]; zero without hardening
  double gs = 0;        ///< MPa
  double range = 0;     ///< gs - g0 [MPa]
  double exponent = 1;  ///< 1 without hardening
};

/// a^p for a >= 0, p > 0.
inline v4 power(v4 a, double p) { return exp(p * log(max(a, broadcast(1e-300)))); }

/// The root y in [0, b] of y + a y^exponent = b, a >= 0, b >= 0. Newton's method in y, or in
/// y^exponent where the exponent is below 1: the function is convex, so that the iteration falls to
/// the root from an upper bound. A lane that does not fall any more stands still.
inline v4 voce_root(v4 a, v4 b, double exponent) {
  const bool steep = exponent >= 1.0;
  const double p = steep ? exponent : 1.0 / exponent;
  const v4 one = broadcast(1.0), tiny = broadcast(1e-300);
  const v4 curved = steep ? a : one, straight = steep ? one : a;  // curved z^p + straight z = b
  v4 z = min(b / max(straight, tiny), power(b / max(curved, tiny), 1.0 / p));
  m4 open = z > 0.0;
  for (int iteration = 0; iteration < 60 && any(open); ++iteration) {
    const v4 slope = curved * power(z, p - 1.0);
    const v4 fall = (slope * z + straight * z - b) / (p * slope + straight);
    open = open & (fall > 2e-16 * z);
    z = select(open, z - fall, z);
  }
  return steep ? z : power(z, p);
}

/// End-of-step g [MPa] after a weighted sum of slip h >= 0 [1]: g = g_old + h0 Y(g)^exponent h. In
/// closed form for exponent 1, by Newton's method otherwise. Rounding never lowers g.
inline v4 voce_strength(const VoceConstants& c, v4 g_old, v4 h) {
  const v4 y = c.rate * h;
  if (c.exponent == 1.0) return g_old + (c.gs - g_old) * (y / (1.0 + y));
  const v4 b = max((c.gs - g_old) * (1.0 / c.range), broadcast(0.0));
  return g_old + c.range * max(b - voce_root(y, b, c.exponent), broadcast(0.0));
}

/// The twin of voce_strength: dg/dh at its value g [MPa].
inline v4 voce_strength_derivative(const VoceConstants& c, v4 g_old, v4 h, v4 g) {
  if (c.exponent == 1.0) {
    const v4 y = 1.0 + c.rate * h;
    return c.rate * (c.gs - g_old) / (y * y);
  }
  const v4 fraction = max((c.gs - g) * (1.0 / c.range), broadcast(1e-300));
  const v4 rate = c.rate * power(fraction, c.exponent);
  return c.range * rate / (1.0 + c.exponent * h * rate / fraction);
}

}  // namespace polyslip::material::simd
