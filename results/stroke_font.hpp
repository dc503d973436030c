#pragma once
// Letters as polylines on a grid 4 wide and 6 high, for the few labels of the picture.

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace polyslip::results {

/// Points (column, height above the base line).
using Polyline = std::vector<std::array<double, 2>>;

struct Glyph {
  char character;
  double advance;  ///< to the next letter, same grid
  std::vector<Polyline> strokes;
};

/// The letter; a space for what the font lacks.
const Glyph& glyph(char character);

inline constexpr double glyph_height = 6;

}  // namespace polyslip::results
