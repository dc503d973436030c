#include "results/analysis/map_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "results/svg.hpp"

namespace polyslip::results::analysis {
namespace {

// Pixels.
constexpr double panel_width = 210, gap = 22, title_height = 24, below_height = 20, legend = 110;
constexpr double caption_height = 8;

constexpr const char* style = R"(<style>
text{font:12px system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif;fill:#1f2328}
.t{font-weight:600;font-size:13px;text-anchor:middle}.b{text-anchor:middle}
.ground{fill:#ffffff}.edge{fill:none;stroke:#57606a;stroke-width:1}
.line{fill:none;stroke:#000000;stroke-opacity:.45;stroke-width:.5}
.mark{fill:#ffffff;stroke:#000000;stroke-width:1}
.halo{paint-order:stroke;stroke:#ffffff;stroke-width:3px;stroke-linejoin:round;fill:#000000}
.path{fill:none;stroke:#d1242f;stroke-width:2;stroke-linejoin:round}.start{fill:#d1242f}
@media(prefers-color-scheme:dark){text{fill:#e6edf3}.ground{fill:#0d1117}.edge{stroke:#9ea7b3}
.halo{fill:#000000}}
</style>
)";

// Viridis at nine equal steps (S. van der Walt, N. Smith; CC0).
constexpr std::array<std::array<double, 3>, 9> viridis{{{68, 1, 84},
                                                        {71, 44, 122},
                                                        {59, 81, 139},
                                                        {44, 113, 142},
                                                        {33, 144, 141},
                                                        {39, 173, 129},
                                                        {92, 200, 99},
                                                        {170, 220, 50},
                                                        {253, 231, 37}}};

/// One panel, drawn into a frame whose upper left corner is (left, top).
class Drawing {
 public:
  Drawing(const MapPanel& panel, double left, double top, int number)
      : p_(panel),
        left_(left),
        top_(top),
        scale_(panel_width / (panel.high[0] - panel.low[0])),
        number_(number) {}

  static double height(const MapPanel& p) {
    return panel_width * (p.high[1] - p.low[1]) / (p.high[0] - p.low[0]);
  }

  std::string text(const std::vector<double>& levels) {
    add("<text class=\"t\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left_ + panel_width / 2,
        top_ - 8, svg_escaped(p_.title));
    add("<clipPath id=\"c{}\"><path d=\"{}\"/></clipPath>\n<g clip-path=\"url(#c{})\">\n", number_,
        outline(), number_);
    add("<g shape-rendering=\"crispEdges\">\n<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" "
        "height=\"{:.1f}\" fill=\"{}\"/>\n",
        left_, top_, panel_width, height(p_), level_colour(0, levels.size() + 1));
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const std::string d = region(levels[k]);
      if (!d.empty())
        add("<path fill=\"{}\" d=\"{}\"/>\n", level_colour(k + 1, levels.size() + 1), d);
    }
    add("</g>\n");
    for (const double level : levels) {
      const std::string d = contour(level);
      if (!d.empty()) add("<path class=\"line\" d=\"{}\"/>\n", d);
    }
    add("</g>\n<path class=\"edge\" d=\"{}\"/>\n", outline());
    for (const auto& path : p_.paths) draw_path(path);
    for (const auto& mark : p_.marks) draw_mark(mark);
    if (!p_.below.empty())
      add("<text class=\"b\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left_ + panel_width / 2,
          top_ + height(p_) + 15, svg_escaped(p_.below));
    return text_;
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  Place screen(const Place& x) const {
    return {left_ + (x[0] - p_.low[0]) * scale_, top_ + (p_.high[1] - x[1]) * scale_};
  }
  Place node(double column, double row) const {
    return screen({p_.low[0] + (p_.high[0] - p_.low[0]) * column / (p_.columns - 1),
                   p_.low[1] + (p_.high[1] - p_.low[1]) * row / (p_.rows - 1)});
  }
  double value(int column, int row) const {
    return p_.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(p_.columns) +
                     static_cast<std::size_t>(column)];
  }

  std::string outline() const {
    std::vector<Place> polygon = p_.outline;
    if (polygon.empty())
      polygon = {p_.low, {p_.high[0], p_.low[1]}, p_.high, {p_.low[0], p_.high[1]}};
    std::string d;
    for (const Place& x : polygon) {
      const Place s = screen(x);
      d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", s[0], s[1]);
    }
    return d + "Z";
  }

  /// Corners of a cell, anticlockwise from its low one.
  static constexpr std::array<std::array<int, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

  /// Where the contour crosses the side from corner i to the next one.
  Place crossing(int column, int row, std::size_t i, double level) const {
    const auto &a = corners[i], &b = corners[(i + 1) % 4];
    const double fa = value(column + a[0], row + a[1]), fb = value(column + b[0], row + b[1]);
    const double t = (level - fa) / (fb - fa);
    return node(column + a[0] + t * (b[0] - a[0]), row + a[1] + t * (b[1] - a[1]));
  }

  /// What of a cell lies at or above the level, and the sides that the contour crosses.
  void cut(int column, int row, double level, std::vector<Place>& inside,
           std::vector<Place>& crossings) const {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto &a = corners[i], &b = corners[(i + 1) % 4];
      const bool here = value(column + a[0], row + a[1]) >= level;
      const bool next = value(column + b[0], row + b[1]) >= level;
      if (here) inside.push_back(node(column + a[0], row + a[1]));
      if (here == next) continue;
      crossings.push_back(crossing(column, row, i, level));
      inside.push_back(crossings.back());
    }
  }

  /// Whole cells in runs, the others as polygons.
  std::string region(double level) const {
    std::string d;
    for (int row = 0; row + 1 < p_.rows; ++row) {
      int run = -1;
      for (int column = 0; column + 1 < p_.columns; ++column) {
        std::vector<Place> inside, crossings;
        cut(column, row, level, inside, crossings);
        const bool whole = crossings.empty() && !inside.empty();
        if (whole && run < 0) run = column;
        if (whole && column + 2 < p_.columns) continue;
        if (run >= 0) {
          add_polygon(d, {node(run, row), node(column + (whole ? 1 : 0), row),
                          node(column + (whole ? 1 : 0), row + 1), node(run, row + 1)});
          run = -1;
        }
        if (!whole && inside.size() > 2) add_polygon(d, inside);
      }
    }
    return d;
  }

  static void add_polygon(std::string& d, const std::vector<Place>& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", polygon[i][0], polygon[i][1]);
    d += "Z";
  }

  std::string contour(double level) const {
    std::string d;
    for (int row = 0; row + 1 < p_.rows; ++row)
      for (int column = 0; column + 1 < p_.columns; ++column) {
        std::vector<Place> inside, crossings;
        cut(column, row, level, inside, crossings);
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
          d += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", crossings[i][0], crossings[i][1],
                           crossings[i + 1][0], crossings[i + 1][1]);
      }
    return d;
  }

  void draw_path(const std::vector<Place>& path) {
    std::string d;
    for (const Place& x : path) {
      const Place s = screen(x);
      d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", s[0], s[1]);
    }
    const Place start = screen(path.front());
    add("<path class=\"path\" d=\"{}\"/><circle class=\"start\" cx=\"{:.1f}\" cy=\"{:.1f}\" "
        "r=\"4\"/>\n",
        d, start[0], start[1]);
  }

  void draw_mark(const MapMark& mark) {
    const Place s = screen(mark.at);
    add("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>", s[0], s[1]);
    const bool right = s[0] > left_ + 0.8 * panel_width;
    add("<text class=\"halo\" x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", s[0] + (right ? -5 : 5),
        s[1] + 4, right ? " text-anchor=\"end\"" : "", svg_escaped(mark.label));
  }

  const MapPanel& p_;
  double left_, top_, scale_;
  int number_;
  std::string text_;
};

void check(const MapPanel& p) {
  const bool fits =
      p.columns >= 2 && p.rows >= 2 &&
      p.values.size() == static_cast<std::size_t>(p.columns) * static_cast<std::size_t>(p.rows);
  if (!fits ||
      !std::all_of(p.values.begin(), p.values.end(), [](double v) { return std::isfinite(v); }))
    throw core::InternalError(
        fmt::format("map '{}': {} x {} places and {} values, or some are not "
                    "finite",
                    p.title, p.columns, p.rows, p.values.size()));
}

std::string legend_text(const std::vector<double>& levels, double left, double top, double largest,
                        const std::string& unit) {
  std::string text =
      fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, top - 8, unit);
  const auto count = levels.size() + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = count - 1 - i;
    text +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"18\" fill=\"{}\"/>\n",
                    left, top + 18.0 * static_cast<double>(i), level_colour(k, count));
    if (k > 0)
      text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:.4g}</text>\n", left + 24,
                          top + 18.0 * static_cast<double>(i) + 22, levels[k - 1]);
  }
  return text + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">max {:.2f}</text>\n", left,
                            top + 18.0 * static_cast<double>(count) + 20, largest);
}

}  // namespace

std::vector<double> contour_levels(double largest) {
  for (const double step : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0}) {
    if (largest / step > 12.5 && step < 1000) continue;
    std::vector<double> levels;
    if (step > 1) levels.push_back(1);
    for (int i = 1; i <= 12 && i * step < largest; ++i) levels.push_back(i * step);
    if (levels.size() > 12) levels.pop_back();
    return levels;
  }
  return {1};
}

std::string level_colour(std::size_t level, std::size_t levels) {
  const double t = levels > 1 ? static_cast<double>(level) / static_cast<double>(levels - 1) : 0;
  const double at = t * (viridis.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), viridis.size() - 2);
  std::string colour = "#";
  for (std::size_t c = 0; c < 3; ++c)
    colour += fmt::format(
        "{:02x}",
        static_cast<int>(std::lround(viridis[i][c] + (at - static_cast<double>(i)) *
                                                         (viridis[i + 1][c] - viridis[i][c]))));
  return colour;
}

std::string map_svg(const std::vector<MapPanel>& panels, int per_row, const std::string& caption,
                    const std::string& unit) {
  if (panels.empty()) throw core::InternalError("map: no panels");
  double largest = 0, height = 0;
  for (const MapPanel& p : panels) {
    check(p);
    largest = std::max(largest, *std::max_element(p.values.begin(), p.values.end()));
    height = std::max(height, Drawing::height(p));
  }
  const auto levels = contour_levels(largest);
  const int count = static_cast<int>(panels.size()), across = std::min(count, per_row);
  const int down = (count + per_row - 1) / per_row;
  const double row_height = title_height + height + below_height + 6;
  const double legend_height = title_height + 18.0 * static_cast<double>(levels.size() + 1) + 30;
  const double width = gap + across * (panel_width + gap) + legend;
  const double whole = caption_height + std::max(down * row_height, legend_height);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"0 0 "
      "{:.0f} {:.0f}\" role=\"img\">\n<title>{}</title>\n{}<rect class=\"ground\" width=\"100%\" "
      "height=\"100%\"/>\n",
      width, whole, width, whole, svg_escaped(caption), style);
  for (int i = 0; i < count; ++i)
    text += Drawing(panels[static_cast<std::size_t>(i)], gap + (i % per_row) * (panel_width + gap),
                    caption_height + title_height + (i / per_row) * row_height, i)
                .text(levels);
  return text +
         legend_text(levels, gap + across * (panel_width + gap), caption_height + title_height,
                     largest, unit) +
         "</svg>\n";
}

}  // namespace polyslip::results::analysis
