#pragma once
// Our own random numbers: the same on every machine, library, rank and thread count.

#include <array>
#include <cmath>
#include <cstdint>

#include "core/types.hpp"

namespace polyslip::core {

/// One step of splitmix64 (Steele, Lea, Flood 2014): advances `state`, returns a mixed word.
inline std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Which draws belong together. Streams of one seed are independent of each other, so that a change
/// of how many numbers one use takes leaves the other uses alone.
enum class Stream : std::uint64_t { seeds = 1, orientations = 2, texture = 20, tests = 1000 };

/// xoshiro256** (Blackman, Vigna 2018), seeded by splitmix64 from (seed, stream).
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) {
    std::uint64_t a = seed;
    std::uint64_t b = splitmix64(a) ^ (stream + 0x632be59bd9b4e019ULL);
    for (auto& word : state_) word = splitmix64(b);
  }
  Random(std::uint64_t seed, Stream stream) : Random(seed, static_cast<std::uint64_t>(stream)) {}

  /// 64 random bits.
  std::uint64_t bits() {
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform integer in [0, n), n > 0, without bias (rejection).
  std::uint64_t index(std::uint64_t n) {
    const std::uint64_t limit = UINT64_MAX - UINT64_MAX % n;
    std::uint64_t x = bits();
    while (x >= limit) x = bits();
    return x % n;
  }

  /// Standard normal (Marsaglia's polar method; the second number is dropped, so no hidden state).
  double normal() {
    while (true) {
      const double x = uniform(-1, 1), y = uniform(-1, 1);
      const double s = x * x + y * y;
      if (s > 0 && s < 1) return x * std::sqrt(-2 * std::log(s) / s);
    }
  }

  /// Uniform random rotation: a point on the unit sphere of four dimensions (Marsaglia 1972). The
  /// distribution is that of Shoemake's formula; this form has square roots only, which IEEE 754
  /// rounds exactly, whereas sine and cosine differ in the last bit between processors.
  Quaternion rotation() {
    const auto [a, b] = in_disc();
    const auto [c, d] = in_disc();
    const double s1 = a * a + b * b, s2 = c * c + d * d;
    const double t = std::sqrt((1 - s1) / s2);
    return Quaternion(a, b, c * t, d * t).normalized();
  }

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

  /// Uniform in the unit disc without its centre.
  std::array<double, 2> in_disc() {
    while (true) {
      const double x = uniform(-1, 1), y = uniform(-1, 1);
      const double s = x * x + y * y;
      if (s > 0 && s < 1) return {x, y};
    }
  }

  std::array<std::uint64_t, 4> state_{};
};

}  // namespace polyslip::core
