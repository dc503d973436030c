#pragma once
// A small software rasteriser: triangles with a depth buffer, lines, and a PNG of the result.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace polyslip::results {

using Rgb = std::array<double, 3>;  ///< 0 ... 255

/// Point of the picture: x to the right, y downwards [pixels], depth away from the eye [pixels].
using ScreenPoint = core::Vec3;

/// What a line is drawn as; a later one wins where they meet.
enum class Stroke : std::uint8_t { none, element_edge, grain_boundary, ink };

/// White at first. Each pixel is the mean of `samples` x `samples` samples.
class Canvas {
 public:
  Canvas(int width, int height, int samples = 3);

  void fill(const std::array<ScreenPoint, 3>& triangle, const Rgb& colour);
  /// A line with round ends on the surfaces filled before: hidden where one of them is nearer by
  /// more than `tolerance` [pixels of depth]. Ink is never hidden.
  void line(const ScreenPoint& from, const ScreenPoint& to, double width, Stroke stroke,
            double tolerance = 4);
  /// Strokes in a built-in font of digits, capital D, N, R, T, "=", "." and "e" (epsilon). `at`:
  /// left end of the base line; height of capitals in pixels. Returns the width.
  double text(const core::Vec3& at, const std::string& characters, double height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// [height][width][3]
  std::vector<std::uint8_t> pixels() const;
  /// Writes it, whole or not at all. InputError if that is impossible.
  void write_png(const std::string& path) const;

 private:
  int width_, height_, samples_;
  int columns_, rows_;        ///< of samples
  std::vector<float> depth_;  ///< [rows][columns]
  std::vector<std::array<std::uint8_t, 3>> colour_;
  std::vector<Stroke> stroke_;
};

/// Width of a text that `Canvas::text` would draw.
double text_width(const std::string& characters, double height);

}  // namespace polyslip::results
