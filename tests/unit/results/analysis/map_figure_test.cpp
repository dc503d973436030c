// Maps: levels, colours, what the SVG holds.

#include "results/analysis/map_figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "results/analysis/components.hpp"
#include "results/analysis/texture_maps.hpp"

namespace {

using namespace polyslip;
using namespace polyslip::results::analysis;

MapPanel slope(int n) {
  MapPanel p;
  p.title = "a < b & c";
  p.columns = p.rows = n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) p.values.push_back(3.0 * i / (n - 1));
  return p;
}

int count(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

TEST(MapFigure, LevelsAreRoundAndFew) {
  for (const double largest : {0.5, 1.0, 2.4, 8.4, 13.0, 60.0, 900.0, 5e4}) {
    const auto levels = contour_levels(largest);
    ASSERT_FALSE(levels.empty()) << largest;
    EXPECT_LE(levels.size(), 12u);
    for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_GT(levels[i], levels[i - 1]);
    if (largest <= 1) continue;
    EXPECT_LT(levels.back(), largest);
    EXPECT_EQ(std::count(levels.begin(), levels.end(), 1.0), 1) << largest;
  }
}

TEST(MapFigure, AreaAboveALevelIsCutExactly) {
  // Of a slope from 0 to 3 the levels 1 and 2 leave rectangles: one run a row and its cut cell.
  const std::string svg = map_svg({slope(4)}, 1, "slope");
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(count(svg, "<svg"), 1);
  EXPECT_EQ(count(svg, "clipPath id="), 1);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(MapFigure, RefusesWhatDoesNotFit) {
  MapPanel p = slope(4);
  p.values.pop_back();
  EXPECT_THROW(map_svg({p}, 1, "x"), core::InternalError);
  p = slope(4);
  p.values[3] = std::nan("");
  EXPECT_THROW(map_svg({p}, 1, "x"), core::InternalError);
  EXPECT_THROW(map_svg({}, 1, "x"), core::InternalError);
}

TEST(TextureMaps, GridsHoldTheDensityWhereTheySay) {
  const auto q = core::from_bunge({30, 40, 55});
  const Sample sample{{q}, {1}};
  const Odf odf(sample, 10 * std::numbers::pi / 180);
  const BungeGrid bunge = bunge_grid(odf, 5);
  EXPECT_EQ(bunge.n1, 73);
  EXPECT_NEAR(bunge.at(6, 8, 11), odf.at(q), 1e-9);
  EXPECT_NEAR(bunge.at(0, 3, 4), bunge.at(72, 3, 4), 1e-9);
  EXPECT_NEAR(bunge.at(7, 3, 0), bunge.at(7, 3, 18), 1e-9);
  EXPECT_EQ(bunge_panels(bunge).size(), 19u);
  EXPECT_EQ(bunge_grid(Odf(sample, 0.2, SampleSymmetry::orthorhombic), 10).n1, 10);
  const RodriguesGrid r = rodrigues_grid(odf, 13);
  EXPECT_NEAR(r.at(2, 7, 12), odf.at(core::from_rodrigues({r.place(2), r.place(7), r.place(12)})),
              1e-12);
  // Of 13 places along r3 every other one is a layer of the sections.
  const RodriguesSections layers = rodrigues_sections(odf, 13), nearest = sections_of(r);
  ASSERT_EQ(layers.density.size(), 7u * 13 * 13);
  ASSERT_EQ(nearest.density.size(), layers.density.size());
  for (int s = 0; s < layers.count; ++s) {
    EXPECT_NEAR(layers.r3[s], r.place(2 * s), 1e-12);
    EXPECT_EQ(nearest.r3[s], r.place(2 * s));
    for (const std::size_t at : {std::size_t{0}, std::size_t{100}, std::size_t{168}})
      EXPECT_NEAR(layers.density[s * 169 + at], nearest.density[s * 169 + at], 1e-9);
  }
  EXPECT_NEAR(nearest.density[3 * 169 + 7 * 13 + 2], r.at(2, 7, 6), 0);
  EXPECT_EQ(rodrigues_panels(layers).size(), 7u);
  const PoleFigure figure(sample, {1, 1, 1}, 0.2);
  const DiscGrid disc = disc_grid(figure, 21);
  EXPECT_NEAR(disc.density[10 * 21 + 10], figure.at({0, 0, 1}), 1e-12);
  EXPECT_NEAR(disc.density[4 * 21 + 12],
              figure.at(from_equal_area({disc.place(12), disc.place(4)})), 1e-12);
  const InversePoleFigure inverse(sample, {0, 0, 1}, 0.2);
  const TriangleGrid triangle = triangle_grid(inverse, 30);
  EXPECT_NEAR(triangle.density[static_cast<std::size_t>(5 * triangle.nx + 9)],
              inverse.at(from_equal_area({triangle.x(9), triangle.y(5)})), 1e-12);
  EXPECT_FALSE(
      map_svg({pole_figure_panel(disc, "a"), inverse_pole_figure_panel(triangle, "b")}, 2, "both")
          .empty());
}

}  // namespace
