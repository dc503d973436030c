#pragma once
// Four doubles at a time: loads, selection, and logarithm and exponential with their polynomials
// (docs/theory-material.md, "Power function"). Private to material: include it from .cpp files that
// are compiled for the native machine.

#include <array>
#include <cstdint>
#include <cstring>

namespace polyslip::material::simd {

typedef double v4 __attribute__((vector_size(32)));
typedef std::uint64_t u4 __attribute__((vector_size(32)));
/// Lanes of -1 (true) or 0 (false).
using m4 = decltype(v4{} < v4{});

inline v4 broadcast(double a) { return v4{a, a, a, a}; }

/// Four consecutive doubles, of any alignment.
inline v4 load(const double* p) {
  v4 a;
  std::memcpy(&a, p, sizeof a);
  return a;
}
inline void store(double* p, v4 a) { std::memcpy(p, &a, sizeof a); }

inline bool any(m4 m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }
inline bool all(m4 m) { return (m[0] & m[1] & m[2] & m[3]) != 0; }
inline v4 select(m4 m, v4 a, v4 b) { return m ? a : b; }
inline v4 max(v4 a, v4 b) { return a > b ? a : b; }
inline v4 min(v4 a, v4 b) { return a < b ? a : b; }
inline v4 abs(v4 a) {
  const u4 magnitude = u4{} + 0x7fffffffffffffffULL;
  return (v4)((u4)a & magnitude);
}
/// |a| with the sign bit of s.
inline v4 copysign(v4 a, v4 s) {
  const u4 magnitude = u4{} + 0x7fffffffffffffffULL;
  return (v4)(((u4)a & magnitude) | ((u4)s & ~magnitude));
}
/// True where a is neither infinite nor NaN.
inline m4 finite(v4 a) { return abs(a) <= 1.7976931348623157e308; }

inline v4 sqrt(v4 a) {
  return v4{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])};
}

inline constexpr double ln2_high = 0x1.62e42feep-1;       // 33 bits: exact times an exponent
inline constexpr double ln2_low = 0x1.a39ef35793c76p-33;  // ln 2 - ln2_high

/// Natural logarithm of a normal positive number: x = 2^k (1 + f), 1 + f in [sqrt(1/2), sqrt 2),
/// ln(1 + f) = 2 artanh(s), s = f / (2 + f). Error below 1.5e-16 |ln x| + 1e-16 |f|.
inline v4 log(v4 x) {
  const u4 one = u4{} + 0x3ff0000000000000ULL;
  const u4 root_half = u4{} + 0x3fe6a09e667f3bcdULL;
  const u4 exponent = ((u4)x + (one - root_half)) >> 52;  // k + 1023
  const u4 two52 = u4{} + 0x4330000000000000ULL;
  const v4 k = (v4)(exponent | two52) - (4503599627370496.0 + 1023.0);
  const v4 f = (v4)((u4)x - (exponent << 52) + one) - 1.0;
  const v4 s = f / (2.0 + f);
  const v4 z = s * s;
  // R = 2 artanh(s)/s - 2 = sum of 2 z^j / (2 j + 1), z <= 0.0295; even and odd powers apart, two
  // short chains of operations instead of a long one
  const v4 zz = z * z;
  v4 odd = broadcast(2.0 / 23), even = broadcast(2.0 / 21);
  for (int j = 9; j >= 1; j -= 2) {
    odd = odd * zz + 2.0 / (2 * j + 1);
    if (j > 1) even = even * zz + 2.0 / (2 * j - 1);
  }
  const v4 r = z * (odd + z * even);
  const v4 h = 0.5 * f * f;
  return k * ln2_high + (f - (h - (s * (h + r) + k * ln2_low)));
}

inline constexpr std::array<double, 14> inverse_factorial = [] {
  std::array<double, 14> a = {1.0};
  for (std::size_t j = 1; j < a.size(); ++j) a[j] = a[j - 1] / static_cast<double>(j);
  return a;
}();

/// Exponential; zero below -690, x taken as 690 above 690. Error below 2e-16 relative.
inline v4 exp(v4 x) {
  const v4 clipped = max(min(x, broadcast(690.0)), broadcast(-690.0));
  const double to_integer = 6755399441055744.0;  // 1.5 * 2^52: its last bits hold k
  const v4 shifted = clipped * 1.4426950408889634 + to_integer;
  const v4 k = shifted - to_integer;
  const v4 r = (clipped - k * ln2_high) - k * ln2_low;  // |r| <= ln(2)/2
  const v4 rr = r * r;                                  // even and odd powers apart, as in log
  v4 odd = broadcast(inverse_factorial[13]), even = broadcast(inverse_factorial[12]);
  for (std::size_t j = 6; j-- > 0;) {
    odd = odd * rr + inverse_factorial[2 * j + 1];
    even = even * rr + inverse_factorial[2 * j];
  }
  const v4 sum = even + r * odd;
  const v4 scaled = (v4)((u4)sum + ((u4)shifted << 52));
  return select(x < -690.0, broadcast(0.0), scaled);
}

}  // namespace polyslip::material::simd
