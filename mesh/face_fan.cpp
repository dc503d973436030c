#include "mesh/face_fan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Vec2 = Eigen::Vector2d;

double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool on_segment(const Vec2& a, const Vec2& b, const Vec2& p) { return (p - a).dot(p - b) <= 0; }

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double abc = orientation(a, b, c), abd = orientation(a, b, d);
  const double cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 &&
      cdb != 0)
    return true;
  return (abc == 0 && on_segment(a, b, c)) || (abd == 0 && on_segment(a, b, d)) ||
         (cda == 0 && on_segment(c, d, a)) || (cdb == 0 && on_segment(c, d, b));
}

bool is_simple(const std::vector<Vec2>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segments_meet(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n])) return false;
    }
  return true;
}

}  // namespace

Vec3 fan_master(std::span<const Vec3> loop, int master) {
  if (master >= 0) return loop[static_cast<std::size_t>(master)];
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : loop) sum += x;
  return sum / static_cast<double>(loop.size());
}

Vec3 vector_area(std::span<const Vec3> loop) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    area += 0.5 * (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  return area;
}

double fan_fault(std::span<const Vec3> loop, int master) {
  std::vector<Vec3> normals;
  normals.reserve(loop.size());
  bool flat = true;
  for_each_fan_triangle(loop, master, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
    const Vec3 normal = (b - a).cross(m - a);
    const double norm = normal.norm();
    if (!(norm > 0)) flat = false;
    normals.push_back(normal / norm);
  });
  if (!flat) return std::numeric_limits<double>::infinity();
  double fault = 0;
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (std::size_t j = i + 1; j < normals.size(); ++j)
      fault = std::max(fault, (normals[i] - normals[j]).squaredNorm());
  return fault;
}

double chord_of_degrees(double degrees) {
  const double s = std::sin(0.5 * std::min(degrees, 180.0) * std::numbers::pi / 180);
  return 4 * s * s;
}

double degrees_of_chord(double chord) {
  return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(chord))) * 180 / std::numbers::pi;
}

BestFan best_fan(std::span<const Vec3> loop) {
  if (loop.size() == 3) return {-1, 0};
  BestFan best{-1, fan_fault(loop, -1)};
  for (int i = 0; i < static_cast<int>(loop.size()); ++i) {
    const double fault = fan_fault(loop, i);
    if (fault < best.fault) best = {i, fault};
  }
  return best;
}

bool unfolded_in_projection(std::span<const Vec3> loop, int master) {
  const Vec3 area = vector_area(loop);
  const double norm = area.norm();
  if (!(norm > 0)) return false;
  const Vec3 normal = area / norm;
  bool positive = true;
  for_each_fan_triangle(loop, master, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
    if (!((b - a).cross(m - a).dot(normal) > 0)) positive = false;
  });
  if (!positive) return false;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Vec2> polygon;
  polygon.reserve(loop.size());
  for (const Vec3& x : loop) polygon.emplace_back(u.dot(x - loop[0]), v.dot(x - loop[0]));
  return is_simple(polygon);
}

}  // namespace polyslip::mesh
