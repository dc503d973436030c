#include "results/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/plot_axis.hpp"
#include "results/svg.hpp"

namespace polyslip::results {
namespace {

// All in pixels.
constexpr double panel_width = 470, margin_left = 66, margin_right = 18;
constexpr double title_height = 30, legend_line = 18, frame_height = 270, axis_height = 52;
constexpr double letter_width = 6.4;  // of the legend's 12 pixel type, on average
constexpr int colours = 7;            // classes c0 ... c6 of the style

// Okabe and Ito's colours, which the colour-blind can tell apart, darker or lighter by ground.
constexpr const char* style = R"(<style>
text{font:12px system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif;fill:#1f2328}
.title{font-weight:600;font-size:13px}
.small{fill:#57606a}
.ground{fill:#ffffff}
.grid{stroke:#d8dee4;stroke-width:1}
.axis{stroke:#57606a;stroke-width:1;fill:none}
.s{fill:none;stroke-width:1.8;stroke-linejoin:round}
.d{stroke-dasharray:6 4}
.s.h{stroke-width:.6;stroke:#57606a}
.f{stroke:none;fill-opacity:.16}
.b{stroke-width:1;fill-opacity:.45}
.c0{stroke:#0072b2}.f.c0,.b.c0,.p.c0{fill:#0072b2}
.c1{stroke:#c04f00}.f.c1,.b.c1,.p.c1{fill:#c04f00}
.c2{stroke:#00805d}.f.c2,.b.c2,.p.c2{fill:#00805d}
.c3{stroke:#a3467f}.f.c3,.b.c3,.p.c3{fill:#a3467f}
.c4{stroke:#9a7500}.f.c4,.b.c4,.p.c4{fill:#9a7500}
.c5{stroke:#3a8fc4}.f.c5,.b.c5,.p.c5{fill:#3a8fc4}
.c6{stroke:#57606a}.f.c6,.b.c6,.p.c6{fill:#57606a}
@media(prefers-color-scheme:dark){
text{fill:#e6edf3}.small{fill:#9ea7b3}.ground{fill:#0d1117}.grid{stroke:#262c36}
.axis,.s.h{stroke:#9ea7b3}
.c0{stroke:#4ca6e8}.f.c0,.b.c0,.p.c0{fill:#4ca6e8}
.c1{stroke:#f08a3c}.f.c1,.b.c1,.p.c1{fill:#f08a3c}
.c2{stroke:#2fbf95}.f.c2,.b.c2,.p.c2{fill:#2fbf95}
.c3{stroke:#dc8ebb}.f.c3,.b.c3,.p.c3{fill:#dc8ebb}
.c4{stroke:#e3b93c}.f.c4,.b.c4,.p.c4{fill:#e3b93c}
.c5{stroke:#8ccaf0}.f.c5,.b.c5,.p.c5{fill:#8ccaf0}
.c6{stroke:#9ea7b3}.f.c6,.b.c6,.p.c6{fill:#9ea7b3}
}
</style>
)";

/// Letters of an UTF-8 text.
double letters(const std::string& text) {
  return static_cast<double>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

void check_series(const Series& s) {
  const std::size_t wanted = s.mark == Mark::steps ? s.y.size() + 1 : s.y.size();
  if (s.mark != Mark::arrow && (s.x.size() != wanted || s.y.empty()))
    throw core::InternalError(fmt::format("results/plot: series '{}' has {} and {} values", s.label,
                                          s.x.size(), s.y.size()));
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value, bool positive_only) {
    if (!std::isfinite(value) || (positive_only && !(value > 0))) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Scale scale_of(const PlotAxis& axis, Range range, const std::string& title) {
  if (!(range.low <= range.high) && !(axis.from && axis.to))
    throw core::InternalError("results/plot: nothing to draw in '" + title + "'");
  const Scale round = range.low <= range.high
                          ? Scale::round(range.low, range.high, axis.logarithmic)
                          : Scale(*axis.from, *axis.to, axis.logarithmic);
  return {axis.from.value_or(round.low()), axis.to.value_or(round.high()), axis.logarithmic};
}

/// Distance between neighbouring bars.
double bar_distance(const Series& s) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < s.x.size(); ++i) least = std::min(least, s.x[i] - s.x[i - 1]);
  return std::isfinite(least) && least > 0 ? least : 1;
}

Scale x_scale(const Plot& plot) {
  Range range;
  for (const Series& s : plot.series) {
    const double half = s.mark == Mark::bars ? bar_distance(s) / 2 : 0;
    for (const double x : s.x) {
      range.take(x - half, plot.x.logarithmic);
      range.take(x + half, plot.x.logarithmic);
    }
  }
  return scale_of(plot.x, range, plot.title);
}

Scale y_scale(const Plot& plot) {
  Range range;
  for (const Series& s : plot.series) {
    if (s.mark == Mark::arrow) continue;
    if (s.mark == Mark::bars || s.mark == Mark::steps) range.take(0, plot.y.logarithmic);
    for (const double y : s.y) range.take(y, plot.y.logarithmic);
  }
  return scale_of(plot.y, range, plot.title);
}

/// One panel, its upper left corner at (left, top).
class Panel {
 public:
  Panel(const Plot& plot, double left, double top, double legend_height)
      : plot_(plot),
        x_(x_scale(plot)),
        y_(y_scale(plot)),
        left_(left + margin_left),
        right_(left + panel_width - margin_right),
        top_(top + title_height + legend_height),
        bottom_(top_ + frame_height) {
    add("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + 14, top + 20,
        svg_escaped(plot.title));
    legend(left + 14, top + title_height);
    axes();
    for (std::size_t i = 0; i < plot.series.size(); ++i)
      draw(plot.series[i], static_cast<int>(i) % colours);
  }

  std::string text() { return std::move(text_); }

  /// Height of a legend: entries run on, and break into lines.
  static double legend_height(const Plot& plot) {
    double x = 0, lines = 0;
    for (const Series& s : plot.series) {
      if (s.label.empty()) continue;
      const double width = 34 + letter_width * letters(s.label);
      if (lines == 0 || x + width > panel_width - 24) {
        ++lines;
        x = 0;
      }
      x += width;
    }
    return lines * legend_line + 6;
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  double px(double value) const { return left_ + (right_ - left_) * x_.place(value); }
  double py(double value) const { return bottom_ - (bottom_ - top_) * y_.place(value); }
  /// Where a value is cut at the frame; the foot of the frame for what has no place.
  double py_clamped(double value) const {
    const double y = py(value);
    return std::isnan(y) ? bottom_ : std::clamp(y, top_, bottom_);
  }
  double px_clamped(double value) const { return std::clamp(px(value), left_, right_); }

  void legend(double left, double top) {
    double x = 0, y = top;
    int colour = -1;
    bool first = true;
    for (const Series& s : plot_.series) {
      ++colour;
      if (s.label.empty()) continue;
      const double width = 34 + letter_width * letters(s.label);
      if (!first && x + width > panel_width - 24) {
        x = 0;
        y += legend_line;
      }
      first = false;
      swatch(s.mark, colour % colours, left + x, y + 8);
      add("<text class=\"small\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + x + 23, y + 12,
          svg_escaped(s.label));
      x += width;
    }
  }

  static const char* style_of(Mark mark) {
    return mark == Mark::dashed ? " d" : mark == Mark::fine ? " h" : "";
  }

  void swatch(Mark mark, int c, double x, double y) {
    if (mark == Mark::points)
      add("<circle class=\"p c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>\n", c, x + 9, y);
    else if (mark == Mark::bars)
      add("<rect class=\"b c{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"10\"/>\n", c,
          x + 4, y - 5);
    else if (mark == Mark::arrow)
      add("<path class=\"s c{}\" d=\"M{:.1f} {:.1f}v-11m-3.5 4l3.5 -4l3.5 4\"/>\n", c, x + 9,
          y + 6);
    else
      add("<path class=\"s c{}{}\" d=\"M{:.1f} {:.1f}h18\"/>\n", c, style_of(mark), x, y);
  }

  void axes() {
    for (const Tick& tick : x_.ticks(7)) {
      const double x = px(tick.value);
      if (tick.text.empty()) {
        add("<path class=\"axis\" d=\"M{:.1f} {:.1f}v3\"/>\n", x, bottom_);
        continue;
      }
      add("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x, top_, bottom_);
      add("<path class=\"axis\" d=\"M{:.1f} {:.1f}v5\"/>\n", x, bottom_);
      add("<text text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x, bottom_ + 18,
          tick.text);
    }
    for (const Tick& tick : y_.ticks(6)) {
      const double y = py(tick.value);
      if (tick.text.empty()) {
        add("<path class=\"axis\" d=\"M{:.1f} {:.1f}h-3\"/>\n", left_, y);
        continue;
      }
      add("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", left_, y, right_);
      add("<path class=\"axis\" d=\"M{:.1f} {:.1f}h-5\"/>\n", left_, y);
      add("<text text-anchor=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left_ - 8, y + 4,
          tick.text);
    }
    add("<path class=\"axis\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>\n", left_, top_, bottom_,
        right_);
    add("<text text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", (left_ + right_) / 2,
        bottom_ + 38, svg_escaped(plot_.x.label));
    const double x = left_ - margin_left + 16, y = (top_ + bottom_) / 2;
    add("<text text-anchor=\"middle\" transform=\"translate({:.1f} {:.1f}) rotate(-90)\">{}"
        "</text>\n",
        x, y, svg_escaped(plot_.y.label));
  }

  void draw(const Series& s, int c) {
    switch (s.mark) {
      case Mark::line:
      case Mark::dashed:
      case Mark::fine:
        return curve(s, c);
      case Mark::steps:
        return steps(s, c);
      case Mark::bars:
        return bars(s, c);
      case Mark::points:
        for (std::size_t i = 0; i < s.x.size(); ++i)
          if (inside(s.x[i], s.y[i]))
            add("<circle class=\"p c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>\n", c, px(s.x[i]),
                py(s.y[i]));
        return;
      case Mark::arrow:
        for (const double x : s.x)
          if (x_.place(x) >= 0 && x_.place(x) <= 1)
            add("<path class=\"s c{}\" d=\"M{:.1f} {:.1f}V{:.1f}m-5 9l5 -9l5 9\"/>\n", c, px(x),
                bottom_, top_ + 0.12 * frame_height);
    }
  }

  bool inside(double x, double y) const {
    const double u = x_.place(x), v = y_.place(y);
    return u >= 0 && u <= 1 && v >= 0 && v <= 1;
  }

  /// Beyond the frame's top or foot a curve runs along it; beyond its sides it ends.
  void curve(const Series& s, int c) {
    std::string path;
    bool down = false;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const double u = x_.place(s.x[i]), v = y_.place(s.y[i]);
      if (!(u >= 0 && u <= 1) || std::isnan(v)) {
        down = false;
        continue;
      }
      fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", down ? "L" : "M", px(s.x[i]),
                     py_clamped(s.y[i]));
      down = true;
    }
    add("<path class=\"s c{}{}\" d=\"{}\"/>\n", c, style_of(s.mark), path);
  }

  void steps(const Series& s, int c) {
    std::string path;
    fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}", px_clamped(s.x.front()), bottom_);
    for (std::size_t i = 0; i < s.y.size(); ++i)
      fmt::format_to(std::back_inserter(path), "V{:.1f}H{:.1f}", py_clamped(s.y[i]),
                     px_clamped(s.x[i + 1]));
    fmt::format_to(std::back_inserter(path), "V{:.1f}", bottom_);
    const auto histograms = std::count_if(plot_.series.begin(), plot_.series.end(),
                                          [](const Series& o) { return o.mark == Mark::steps; });
    if (histograms == 1) add("<path class=\"f c{}\" d=\"{}Z\"/>\n", c, path);
    add("<path class=\"s c{}\" d=\"{}\"/>\n", c, path);
  }

  void bars(const Series& s, int c) {
    const double half = 0.4 * bar_distance(s);
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const double a = px_clamped(s.x[i] - half), b = px_clamped(s.x[i] + half);
      const double y = py_clamped(s.y[i]);
      if (b > a && y < bottom_)
        add("<rect class=\"b c{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
            "height=\"{:.1f}\"/>\n",
            c, a, y, b - a, bottom_ - y);
    }
  }

  const Plot& plot_;
  Scale x_, y_;
  double left_, right_, top_, bottom_;
  std::string text_;
};

}  // namespace

Series steps_of(const Histogram& histogram, const std::string& label) {
  Series s{label, Mark::steps, {}, histogram.density()};
  for (int i = 0; i <= static_cast<int>(histogram.counts.size()); ++i)
    s.x.push_back(histogram.edge(i));
  return s;
}

std::string svg_text(const std::vector<Plot>& panels, const std::string& caption) {
  if (panels.empty()) throw core::InternalError("results/plot: no panels");
  for (const Plot& plot : panels)
    for (const Series& s : plot.series) check_series(s);
  const std::size_t columns = panels.size() > 1 ? 2 : 1;
  std::string body;
  double top = 8;
  for (std::size_t row = 0; row < panels.size(); row += columns) {
    const std::size_t end = std::min(row + columns, panels.size());
    double legend = 0;
    for (std::size_t i = row; i < end; ++i)
      legend = std::max(legend, Panel::legend_height(panels[i]));
    for (std::size_t i = row; i < end; ++i) {
      Plot plot = panels[i];
      if (panels.size() > 1)
        plot.title = fmt::format("({}) {}", static_cast<char>('a' + i), plot.title);
      body += Panel(plot, static_cast<double>(i - row) * panel_width, top, legend).text();
    }
    top += title_height + legend + frame_height + axis_height;
  }
  const double width = static_cast<double>(columns) * panel_width;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\">\n<title>{2}</title>\n{3}"
      "<rect class=\"ground\" width=\"{0:.0f}\" height=\"{1:.0f}\"/>\n{4}</svg>\n",
      width, top, svg_escaped(caption), style, body);
}

void write_svg(const std::string& path, const std::vector<Plot>& panels,
               const std::string& caption) {
  core::write_file(path, svg_text(panels, caption));
}

}  // namespace polyslip::results
