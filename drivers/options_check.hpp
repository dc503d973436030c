#pragma once
// What keys of a deck ask of each other.

#include "drivers/options.hpp"

namespace polyslip::drivers {

/// Notes in the deck, with its place, each demand between keys that does not hold:
///   an orientation file if and only if distribution = "file", and one that exists;
///   elastic stability of a cubic crystal: c11 > c12, c11 + 2 c12 > 0 (and c44 > 0);
///   gs > g0, or gs = g0 without hardening;
///   the smallest step is below the first;
///   0 < remeshing strains < final strain; 0 <= output strains <= final strain;
///   element sizes for as many grains as there are;
///   elements of order 2 for a run.
void check_options(core::Deck& deck, const Options& options, Purpose purpose);

}  // namespace polyslip::drivers
