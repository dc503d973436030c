#pragma once
// Periodic pairs of a .tess file.

#include <string>

#include "mesh/tess_parser.hpp"

namespace polyslip::mesh {

/// Gives the tessellation, which is in its place and has its size, the pairs of the file as
/// Periodicity has them: primaries that are secondaries give way to theirs, secondary edges run as
/// their primaries, loops of secondary faces begin at the primary's first vertex, secondaries lie
/// exactly at their translates. Returns what is wrong: empty if all secondaries are within
/// `distance` of their place and pairs fit each other.
std::string join_translates(const TessContent::Translates& translates, double distance,
                            Tessellation& tessellation);

}  // namespace polyslip::mesh
