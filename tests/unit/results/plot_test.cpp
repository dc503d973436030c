#include "results/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <stack>

#include "core/error.hpp"
#include "results/plot_axis.hpp"

namespace polyslip::results {
namespace {

Plot line_plot(std::vector<double> x, std::vector<double> y) {
  Plot plot{.title = "a < b & c"};
  plot.x.label = "x";
  plot.y.label = "y";
  plot.series.push_back({"curve", Mark::line, std::move(x), std::move(y)});
  return plot;
}

int occurrences(const std::string& text, const std::string& what) {
  int n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// Every tag that opens closes, in order.
bool well_formed(const std::string& text) {
  std::stack<std::string> open;
  const std::regex tag("<(/?)([a-z]+)[^>]*?(/?)>");
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    if ((*it)[3].length()) continue;
    if (!(*it)[1].length()) {
      open.push((*it)[2]);
    } else {
      if (open.empty() || open.top() != (*it)[2]) return false;
      open.pop();
    }
  }
  return open.empty() && text.find("</svg>") != std::string::npos;
}

TEST(Plot, IsWholeAndEscaped) {
  const std::string svg = svg_text({line_plot({0, 1, 2}, {0, 3, 1})}, "1 < 2");
  EXPECT_TRUE(well_formed(svg));
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_NE(svg.find("<title>1 &lt; 2</title>"), std::string::npos);
  EXPECT_NE(svg.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("http", svg.find("xmlns") + 40), std::string::npos);  // needs nothing else
}

TEST(Plot, NumbersItsPanels) {
  const Plot p = line_plot({0, 1}, {0, 1});
  const std::string svg = svg_text({p, p, p}, "three");
  EXPECT_TRUE(well_formed(svg));
  for (const char* name : {"(a) ", "(b) ", "(c) "}) EXPECT_EQ(occurrences(svg, name), 1);
  EXPECT_EQ(svg_text({p}, "one").find("(a) "), std::string::npos);
}

TEST(Plot, BreaksACurveWhereThereIsNoNumber) {
  const std::string svg = svg_text({line_plot({0, 1, 2, 3, 4}, {0, 3, std::nan(""), 2, 1})}, "");
  EXPECT_TRUE(std::regex_search(svg, std::regex("d=\"M[0-9. ]+L[0-9. ]+M[0-9. ]+L[0-9. ]+\"")));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Plot, LogarithmicAxesLeaveOutZero) {
  Plot plot = line_plot({1, 2, 3}, {0, 1e-4, 1});
  plot.y.logarithmic = true;
  const std::string svg = svg_text({plot}, "");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("10\u207b\u2074"), std::string::npos);
}

TEST(Plot, DrawsEveryMark) {
  Histogram h(0, 1, 2);
  h.add(0.1);
  h.add(0.9);
  h.add(0.95);
  Plot plot{.title = "marks"};
  plot.series = {steps_of(h, "steps"),
                 {"bars", Mark::bars, {0.2, 0.6}, {1, 2}},
                 {"points", Mark::points, {0.5}, {1}},
                 {"dashed", Mark::dashed, {0, 1}, {0, 1}},
                 {"arrow", Mark::arrow, {0.7}, {}},
                 {"", Mark::fine, {0, 1}, {1, 0}}};
  const std::string svg = svg_text({plot}, "");
  EXPECT_TRUE(well_formed(svg));
  EXPECT_EQ(occurrences(svg, "<rect class=\"b c1\""), 3);  // and one in the legend
  EXPECT_EQ(occurrences(svg, "<circle"), 2);
  EXPECT_EQ(occurrences(svg, "class=\"s c3 d\""), 2);
  EXPECT_EQ(occurrences(svg, "class=\"s c4\""), 2);
  EXPECT_EQ(occurrences(svg, "class=\"s c5 h\""), 1);
}

TEST(Plot, RefusesWhatCannotBeDrawn) {
  const double nan = std::nan("");
  EXPECT_THROW(svg_text({}, ""), core::InternalError);
  EXPECT_THROW(svg_text({line_plot({nan, nan}, {nan, nan})}, ""), core::InternalError);
  EXPECT_THROW(svg_text({line_plot({0, 1, 2}, {0, 1})}, ""), core::InternalError);
  EXPECT_THROW(svg_text({line_plot({}, {})}, ""), core::InternalError);
}

TEST(PlotAxis, HasRoundTicks) {
  const auto texts = [](const Scale& scale, int wanted) {
    std::string all;
    for (const Tick& t : scale.ticks(wanted))
      if (!t.text.empty()) all += t.text + " ";
    return all;
  };
  EXPECT_EQ(texts(Scale(0, 1, false), 6), "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(texts(Scale(-0.3, 0.31, false), 6), "-0.2 0 0.2 ");
  EXPECT_EQ(texts(Scale(0.05, 200, true), 6), "0.1 1 10 100 ");
  EXPECT_EQ(texts(Scale(1e-6, 1, true), 2), "10\u207b\u2076 10\u207b\u00b3 1 ");
  const Scale round = Scale::round(0.03, 11.2, false);
  EXPECT_EQ(round.low(), 0);
  EXPECT_EQ(round.high(), 15);
  EXPECT_DOUBLE_EQ(Scale(1, 100, true).place(10), 0.5);
  EXPECT_TRUE(std::isnan(Scale(1, 100, true).place(0)));
  EXPECT_THROW(Scale(1, 1, false), core::InternalError);
  EXPECT_THROW(Scale(0, 1, true), core::InternalError);
}

}  // namespace
}  // namespace polyslip::results
