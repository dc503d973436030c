#pragma once
// Contoured maps (pole figures, sections) as SVG files that need nothing else, readable on light
// and dark ground.

#include <string>
#include <vector>

#include <Eigen/Core>

namespace polyslip::results::analysis {

using Place = Eigen::Vector2d;

/// A mark with a word beside it, or a path.
struct MapMark {
  Place at;
  std::string label;  ///< may be empty
};

/// One map: values on a regular grid, contoured, cut off at the outline.
struct MapPanel {
  std::string title;
  int columns = 0, rows = 0;              ///< of the grid, at least two each
  Place low = {0, 0}, high = {1, 1};      ///< its corners
  std::vector<double> values;             ///< [rows][columns] from `low`; columns along x
  std::vector<Place> outline;             ///< closed polygon; empty: the grid's rectangle
  std::vector<MapMark> marks;             ///< dots with words
  std::vector<std::vector<Place>> paths;  ///< thick lines with a dot where they begin
  std::string below;                      ///< a line of text under the panel
};

/// Contour levels for values up to `largest`: round steps, 1 among them, twelve at most.
std::vector<double> contour_levels(double largest);

/// Colour of a level among `levels`, "#rrggbb" (viridis, light for high).
std::string level_colour(std::size_t level, std::size_t levels);

/// The SVG text: panels in rows of `per_row`, one legend of levels for all. `caption` for screen
/// readers. InternalError for a panel whose grid and values do not fit, or values not finite.
std::string map_svg(const std::vector<MapPanel>& panels, int per_row, const std::string& caption,
                    const std::string& unit = "times random");

}  // namespace polyslip::results::analysis
