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
constexpr double raise_gain = 0.003;
constexpr double raise_O_share = 0.9;
constexpr double bound_share = 0.98;
constexpr std::size_t grains_a_try = 100;  // of which one may be tried again

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

bool raises(const MeshQuality& candidate, const MeshQuality& present) {
  return candidate.worst > present.worst + raise_gain && candidate.O >= raise_O_share * present.O;
}

std::vector<int> worst_grains(const std::vector<double>& worst, const std::vector<double>& bounds) {
  std::vector<int> grains;
  for (std::size_t i = 0; i < worst.size(); ++i)
    if (worst[i] < bound_share * bounds[i]) grains.push_back(static_cast<int>(i));
  std::stable_sort(grains.begin(), grains.end(), [&](int i, int j) { return worst[i] < worst[j]; });
  grains.resize(std::min(grains.size(), (worst.size() + grains_a_try - 1) / grains_a_try));
  return grains;
}

bool is_good(const SurfaceBounds& bounds, double worst, double O, double target) {
  return target < 1 && worst >= bounds.floor && O >= target * bounds.O;
}

}  // namespace polyslip::mesh
