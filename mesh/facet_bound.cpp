#include "mesh/facet_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

constexpr double accuracy = 1e-7;    // of the fourth corner's place, in longest sides
constexpr double first_step = 0.25;  // of the search, in longest sides
constexpr double start_height = 0.5;

/// 2 r_in/R of a triangle; 0 without area.
double triangle_ratio(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double u = (b - a).norm(), v = (c - b).norm(), w = (a - c).norm();
  const double area = (b - a).cross(c - a).norm() / 2, all = u * v * w * (u + v + w);
  return all > 0 ? 16 * area * area / all : 0;
}

}  // namespace

// Compass search from above the middle of the longest side: the ratio has one maximum on a side.
double best_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  if (!(normal.norm() > 0)) return 0;
  std::array<std::array<Vec3, 2>, 3> sides{{{a, b}, {b, c}, {c, a}}};
  const auto& longest = *std::max_element(
      sides.begin(), sides.end(),
      [](const auto& s, const auto& t) { return (s[1] - s[0]).norm() < (t[1] - t[0]).norm(); });
  const double length = (longest[1] - longest[0]).norm();
  const Vec3 along = (longest[1] - longest[0]) / length, up = normal.normalized();
  const std::array<Vec3, 3> axes{along, up.cross(along), up};
  Vec3 x = (longest[0] + longest[1]) / 2 + start_height * length * up;
  double best = radius_ratio(a, b, c, x);
  for (double step = first_step * length; step > accuracy * length;) {
    bool moved = false;
    for (const Vec3& axis : axes)
      for (const double sign : {1.0, -1.0}) {
        const Vec3 y = x + sign * step * axis;
        const double ratio = radius_ratio(a, b, c, y);
        if (!(ratio > best)) continue;
        best = ratio;
        x = y;
        moved = true;
      }
    if (!moved) step /= 2;
  }
  return best;
}

double best_at_corner(double angle) {
  if (angle >= M_PI / 3) return 1;
  return best_on_triangle(Vec3::Zero(), Vec3::UnitX(), Vec3(std::cos(angle), std::sin(angle), 0));
}

double surface_bound(const SurfaceMesh& surface, double limit) {
  double bound = limit;
  for (const auto& t : surface.triangles) {
    const Vec3 &a = surface.nodes[t[0]], &b = surface.nodes[t[1]], &c = surface.nodes[t[2]];
    // On no triangle is the best less than its own ratio.
    if (triangle_ratio(a, b, c) < bound) bound = std::min(bound, best_on_triangle(a, b, c));
  }
  return bound;
}

}  // namespace polyslip::mesh
