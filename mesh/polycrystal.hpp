#pragma once
// What a deck asks for in [polycrystal], and the tessellation that it gives.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "mesh/domain.hpp"
#include "mesh/laguerre.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// The names that decks use, in the order of the enumeration.
const std::vector<std::string>& morphology_names();
bool is_regular(Morphology morphology);
bool is_laguerre(Morphology morphology);
/// Grains of a regular morphology whose `cells` are given.
int regular_grain_count(const PolycrystalOptions& options);

/// The body of the right shape whose volume is the number of grains. InputError if the options
/// describe none.
Domain polycrystal_domain(const PolycrystalOptions& options);

/// Cubes of a regular morphology's grid along x, y, z. InputError if the grains do not fill the
/// box: the message names the nearest numbers that do.
std::array<int, 3> grid_of(const PolycrystalOptions& options);

/// The tessellation of a Laguerre morphology.
Tessellation laguerre_tessellation(const PolycrystalOptions& options, LaguerreReport& report,
                                   const std::function<void(double fraction)>& progress = {});

/// Seeds of a file, x y z a line in the unit of `domain` (a body of that extent from the origin) or
/// of `half_spaces`; `#` starts a comment. Sets `seeds` and `grains`. InputError "seeds.txt:12:
/// ..." for what is no such line, a seed outside the body, or one as good as another.
void read_seeds(const std::string& path, PolycrystalOptions& options);

}  // namespace polyslip::mesh
