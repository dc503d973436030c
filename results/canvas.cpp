#include "results/canvas.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/stroke_font.hpp"

namespace polyslip::results {
namespace {

constexpr Rgb edge_colour{255, 255, 255};
constexpr double edge_share = 0.38;  ///< how far an element edge lightens what it lies on
constexpr Rgb boundary_colour{24, 24, 28};
constexpr Rgb ink_colour{30, 30, 34};

double level(double colour, Stroke stroke, int channel) {
  switch (stroke) {
    case Stroke::none:
      return colour;
    case Stroke::element_edge:
      return colour + edge_share * (edge_colour[channel] - colour);
    case Stroke::grain_boundary:
      return boundary_colour[channel];
    case Stroke::ink:
      return ink_colour[channel];
  }
  return colour;
}

std::uint8_t rounded(double x) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 255.0)));
}

/// The whole numbers i with low <= i + 1/2 <= high, within [0, size).
std::pair<int, int> centres(double low, double high, int size) {
  return {std::max(0, static_cast<int>(std::ceil(low - 0.5))),
          std::min(size - 1, static_cast<int>(std::floor(high - 0.5)))};
}

}  // namespace

Canvas::Canvas(int width, int height, int samples)
    : width_(width),
      height_(height),
      samples_(samples),
      columns_(width * samples),
      rows_(height * samples) {
  if (width < 1 || height < 1 || samples < 1)
    throw core::InternalError(
        fmt::format("results/canvas: {} x {} pixels, {} samples", width, height, samples));
  const std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  depth_.assign(count, std::numeric_limits<float>::infinity());
  colour_.assign(count, {255, 255, 255});
  stroke_.assign(count, Stroke::none);
}

void Canvas::fill(const std::array<ScreenPoint, 3>& triangle, const Rgb& colour) {
  const ScreenPoint a = samples_ * triangle[0], b = samples_ * triangle[1],
                    c = samples_ * triangle[2];
  const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  if (!(std::abs(area) > 0)) return;
  const std::array<std::uint8_t, 3> rgb{rounded(colour[0]), rounded(colour[1]), rounded(colour[2])};
  const auto [left, right] =
      centres(std::min({a[0], b[0], c[0]}), std::max({a[0], b[0], c[0]}), columns_);
  const auto [top, bottom] =
      centres(std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}), rows_);
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const double x = column + 0.5, y = row + 0.5;
      const double wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
      const double wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
      const double wa = 1 - wb - wc;
      // A little over the rim, so that no gap shows between neighbours.
      if (wa < -1e-9 || wb < -1e-9 || wc < -1e-9) continue;
      const auto depth = static_cast<float>(wa * a[2] + wb * b[2] + wc * c[2]);
      const std::size_t i = static_cast<std::size_t>(row) * columns_ + column;
      if (depth >= depth_[i]) continue;
      depth_[i] = depth;
      colour_[i] = rgb;
    }
}

void Canvas::line(const ScreenPoint& from, const ScreenPoint& to, double width, Stroke stroke,
                  double tolerance) {
  const ScreenPoint a = samples_ * from, d = samples_ * (to - from);
  const double radius = 0.5 * width * samples_;
  const double length2 = d[0] * d[0] + d[1] * d[1];
  const auto [left, right] =
      centres(std::min(a[0], a[0] + d[0]) - radius, std::max(a[0], a[0] + d[0]) + radius, columns_);
  const auto [top, bottom] =
      centres(std::min(a[1], a[1] + d[1]) - radius, std::max(a[1], a[1] + d[1]) + radius, rows_);
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const double x = column + 0.5 - a[0], y = row + 0.5 - a[1];
      const double t = length2 > 0 ? std::clamp((x * d[0] + y * d[1]) / length2, 0.0, 1.0) : 0.0;
      const double dx = x - t * d[0], dy = y - t * d[1];
      if (dx * dx + dy * dy > radius * radius) continue;
      const std::size_t i = static_cast<std::size_t>(row) * columns_ + column;
      const bool hidden = a[2] + t * d[2] > depth_[i] + tolerance * samples_;
      if (stroke != Stroke::ink && hidden) continue;
      stroke_[i] = std::max(stroke_[i], stroke);
    }
}

double text_width(const std::string& characters, double height) {
  double width = 0;
  for (const char c : characters) width += glyph(c).advance * height / glyph_height;
  return width;
}

double Canvas::text(const core::Vec3& at, const std::string& characters, double height) {
  const double scale = height / glyph_height;
  core::Vec3 pen = at;
  for (const char c : characters) {
    for (const auto& stroke : glyph(c).strokes)
      for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
        const auto place = [&](const std::array<double, 2>& p) {
          return ScreenPoint(pen[0] + scale * p[0], pen[1] - scale * p[1], 0);
        };
        line(place(stroke[i]), place(stroke[i + 1]), 0.11 * height, Stroke::ink);
      }
    pen[0] += glyph(c).advance * scale;
  }
  return pen[0] - at[0];
}

std::vector<std::uint8_t> Canvas::pixels() const {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(width_) * height_ * 3);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (int j = 0; j < samples_; ++j)
          for (int i = 0; i < samples_; ++i) {
            const std::size_t s =
                static_cast<std::size_t>(y * samples_ + j) * columns_ + (x * samples_ + i);
            sum += level(colour_[s][channel], stroke_[s], channel);
          }
        out[(static_cast<std::size_t>(y) * width_ + x) * 3 + channel] =
            rounded(sum / (samples_ * samples_));
      }
  return out;
}

void Canvas::write_png(const std::string& path) const {
  const auto data = pixels();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, data.data(), 0, nullptr) == 0)
    throw core::InternalError(fmt::format("results/canvas: {}: {}", path, image.message));
  bytes.resize(size);
  core::write_file(path, bytes);
}

}  // namespace polyslip::results
