#pragma once
// A random deck of a small run.

#include <cstdint>
#include <string>

namespace polyslip::tests {

struct RandomDeck {
  std::string text;
  std::string summary;  ///< in a few words: load, metal, m, rate
};

/// 8 to 15 grains of aluminium, copper or nearly isotropic tungsten; m from 0.3 to 0.02; rates from
/// 1e-6 to 1e3 /s; any type of load, to a strain of 0.15 or there (0.1) and back; one g or twelve.
/// One in ten is so short of Newton iterations that it is likely to stop. The same for the same
/// seed.
RandomDeck random_deck(std::uint64_t seed);

}  // namespace polyslip::tests
