#include "results/picture.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "results/canvas.hpp"

namespace polyslip {
namespace {

using results::Canvas;
using results::Stroke;

std::array<int, 3> pixel(const Canvas& canvas, int x, int y) {
  const auto all = canvas.pixels();
  const std::size_t i = (static_cast<std::size_t>(y) * canvas.width() + x) * 3;
  return {all[i], all[i + 1], all[i + 2]};
}

TEST(Canvas, NearerTrianglesHideFartherOnes) {
  Canvas canvas(20, 20);
  canvas.fill({{{0, 0, 5}, {20, 0, 5}, {0, 20, 5}}}, {255, 0, 0});
  canvas.fill({{{0, 0, 9}, {20, 0, 9}, {0, 20, 9}}}, {0, 255, 0});
  canvas.fill({{{0, 0, 1}, {0, 6, 1}, {6, 0, 1}}}, {0, 0, 255});
  EXPECT_EQ(pixel(canvas, 8, 8), (std::array{255, 0, 0}));
  EXPECT_EQ(pixel(canvas, 1, 1), (std::array{0, 0, 255}));
  EXPECT_EQ(pixel(canvas, 18, 18), (std::array{255, 255, 255}));
}

TEST(Canvas, LinesAreHiddenBehindSurfaces) {
  Canvas canvas(20, 20);
  canvas.fill({{{0, 0, 0}, {20, 0, 0}, {0, 20, 0}}}, {255, 0, 0});
  canvas.line({0, 5, 50}, {20, 5, 50}, 3, Stroke::grain_boundary);
  EXPECT_EQ(pixel(canvas, 5, 4), (std::array{255, 0, 0}));
  EXPECT_LT(pixel(canvas, 19, 5)[0], 50);
  canvas.line({0, 5, 0}, {20, 5, 0}, 3, Stroke::grain_boundary);
  EXPECT_LT(pixel(canvas, 5, 5)[0], 50);
}

TEST(Canvas, NeighboursLeaveNoGap) {
  Canvas canvas(30, 30);
  const core::Vec3 centre(13.3, 14.9, 0);
  const std::array<core::Vec3, 4> rim{{{-9, -9, 0}, {60, -9, 0}, {60, 60, 0}, {-9, 60, 0}}};
  for (int i = 0; i < 4; ++i) canvas.fill({centre, rim[i], rim[(i + 1) % 4]}, {0, 0, 0});
  for (const auto level : canvas.pixels()) ASSERT_EQ(level, 0);
}

TEST(Picture, ShowsBothStatesInTheColoursOfTheirGrains) {
  const tests::TemporaryFolder folder;
  const std::string path = folder / "picture.png";
  results::write_picture(path, tests::fabricated_snapshot(3, 0),
                         tests::fabricated_snapshot(3, 0.6));
  const std::string png = tests::slurp(path);
  ASSERT_GT(png.size(), 10000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  results::write_picture(folder / "again.png", tests::fabricated_snapshot(3, 0),
                         tests::fabricated_snapshot(3, 0.6));
  EXPECT_EQ(tests::slurp(folder / "again.png"), png);
}

TEST(Picture, CannotBeWrittenWhereThereIsNoFolder) {
  const tests::TemporaryFolder folder;
  const auto s = tests::fabricated_snapshot(1, 0.1);
  EXPECT_THROW(results::write_picture(folder / "none/p.png", s, s), core::InputError);
}

}  // namespace
}  // namespace polyslip
