#include "mesh/candidate.hpp"

#include <algorithm>
#include <cmath>

namespace polyslip::mesh {
namespace {

constexpr double highest_floor = 0.2;
constexpr double slid_floor = 0.3;
constexpr double sliver = 0.1;
/// Share of the worst triangle's radius ratio (2 r/R) that elements on it reach.
constexpr double triangle_share = 0.7;
constexpr double alpha = 0.2;  // eq. (5)

/// A radius ratio in steps, as far as it is below `most`.
int steps(double worst, double most) {
  constexpr double step = 0.02;
  return static_cast<int>(std::floor(std::min(worst, most) / step));
}

}  // namespace

SurfaceBounds surface_bounds(const SurfaceMesh& surface, double element_size) {
  if (surface.triangles.empty()) return {};
  double least = 1, sizes = 0;
  for (const auto& t : surface.triangles) {
    const core::Vec3 &a = surface.nodes[t[0]], &b = surface.nodes[t[1]], &c = surface.nodes[t[2]];
    const double u = (b - a).norm(), v = (c - b).norm(), w = (a - c).norm();
    const double area = (b - a).cross(c - a).norm() / 2;
    least = std::min(least, 16 * area * area / (u * v * w * (u + v + w)));
    const double length = (u + v + w) / 3;
    sizes += std::min(length / element_size, element_size / length);
  }
  const double mean = sizes / static_cast<double>(surface.triangles.size());
  return {std::min(highest_floor, triangle_share * least), std::pow(mean, 3 * alpha)};
}

std::pair<int, double> rank_of(double worst, double O) { return {steps(worst, highest_floor), O}; }

std::pair<int, double> rank_of_slid(double worst, double O) {
  return {steps(worst, slid_floor), O};
}

bool replaces(const MeshQuality& candidate, const MeshQuality& present) {
  const int before = steps(present.worst, sliver), after = steps(candidate.worst, sliver);
  if (before != after) return after > before;
  return candidate.O > present.O && candidate.worst >= present.worst;
}

bool is_good(const SurfaceBounds& bounds, double worst, double O, double target) {
  return target < 1 && worst >= bounds.floor && O >= target * bounds.O;
}

}  // namespace polyslip::mesh
