#pragma once
// Initial orientations of the grains.

#include <string>
#include <vector>

#include "core/types.hpp"
#include "drivers/options.hpp"

namespace polyslip::drivers {

/// Uniform random orientations from the seed, in a stream of their own: the tessellation's draws do
/// not move them, and the first n of a larger polycrystal are those of a smaller one.
std::vector<core::Quaternion> uniform_orientations(std::uint64_t seed, int count);

/// One orientation a line: "w x y z" (convention "quaternion", unit to 1e-3, then normalised),
/// "r1 r2 r3" ("rodrigues"), "phi1 Phi phi2" in degrees ("euler-bunge"); see core/rotation.hpp.
/// Empty lines and what follows a # are skipped. InputError "<path>:<line>: ..." for a line that is
/// not that, a number that is not finite, and more or fewer than `count` orientations.
std::vector<core::Quaternion> read_orientations(const std::string& path,
                                                const std::string& convention, int count);

/// As many as the file has, one at least; a number after an orientation's own is its weight, which
/// all lines or none have (then 1).
struct WeightedOrientations {
  std::vector<core::Quaternion> orientations;
  std::vector<double> weights;
};
WeightedOrientations read_weighted_orientations(const std::string& path,
                                                const std::string& convention);
/// "euler-bunge" for a file whose first line names phi1 (as those for MTEX do), else "quaternion".
std::string convention_of_file(const std::string& path);

/// What the deck asks for, one a grain.
std::vector<core::Quaternion> grain_orientations(const Options& options);

}  // namespace polyslip::drivers
