#pragma once
// Plots as SVG files that need nothing else: curves, histograms and bars on plain axes, readable on
// light and dark ground (the viewer's preference decides).

#include <optional>
#include <string>
#include <vector>

#include "results/distribution.hpp"

namespace polyslip::results {

struct PlotAxis {
  std::string label = {};                    ///< with the unit, where there is one
  std::optional<double> from = {}, to = {};  ///< found from the data if not given
  bool logarithmic = false;                  ///< base 10; values that are not positive are left out
};

enum class Mark {
  line,    ///< through the points
  dashed,  ///< the same, for what others say
  steps,   ///< histogram: x holds the edges, one more than y
  bars,    ///< one over each x
  points,
  fine,  ///< a thin grey line: wire frames
  arrow  ///< a vertical one at each x: a distribution of one value; y is not read
};

struct Series {
  std::string label = {};  ///< no entry in the legend if empty
  Mark mark = Mark::line;
  std::vector<double> x = {}, y = {};
};

struct Plot {
  std::string title = {};
  PlotAxis x = {}, y = {};
  std::vector<Series> series = {};
};

/// The density of a histogram.
Series steps_of(const Histogram& histogram, const std::string& label);

/// The text of the SVG file: the panels in rows of at most two, named (a), (b), ... if there are
/// several; `caption` is its title for screen readers. Values that are not finite break a curve.
/// InternalError for a panel without any value to draw or a series of unequal lengths.
std::string svg_text(const std::vector<Plot>& panels, const std::string& caption);

/// Writes it, whole or not at all. InputError if that is impossible.
void write_svg(const std::string& path, const std::vector<Plot>& panels,
               const std::string& caption);

}  // namespace polyslip::results
