#include "remap/point_shares.hpp"

#include <Eigen/Core>
#include <array>
#include <limits>

namespace polyslip::remap {
namespace {

using core::Vec3;

/// Squared distance of two points in barycentric coordinates.
double barycentric_distance(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return d.squaredNorm() + d.sum() * d.sum();
}

using Tetrahedron = std::array<Vec3, 4>;

/// Calls `use` with the centroids of 8^levels parts of the same volume.
template <class Use>
void for_parts(const Tetrahedron& t, int levels, const Use& use) {
  if (levels == 0) {
    use((t[0] + t[1] + t[2] + t[3]) / 4);
    return;
  }
  const auto middle = [&](std::size_t i, std::size_t j) -> Vec3 { return (t[i] + t[j]) / 2; };
  const Vec3 m01 = middle(0, 1), m02 = middle(0, 2), m03 = middle(0, 3);
  const Vec3 m12 = middle(1, 2), m13 = middle(1, 3), m23 = middle(2, 3);
  for (const Tetrahedron& part : std::array<Tetrahedron, 8>{{{t[0], m01, m02, m03},
                                                             {t[1], m01, m12, m13},
                                                             {t[2], m02, m12, m23},
                                                             {t[3], m03, m13, m23},
                                                             {m01, m23, m02, m12},
                                                             {m01, m23, m12, m13},
                                                             {m01, m23, m13, m03},
                                                             {m01, m23, m03, m02}}})
    for_parts(part, levels - 1, use);
}

}  // namespace

std::size_t nearest_point(std::span<const mesh::QuadraturePoint> rule, const Vec3& xi) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t q = 0; q < rule.size(); ++q)
    if (const double d = barycentric_distance(rule[q].xi, xi); d < least) {
      least = d;
      nearest = q;
    }
  return nearest;
}

std::vector<Vec3> share_centroids(std::span<const mesh::QuadraturePoint> rule) {
  constexpr int levels = 4;
  constexpr double rounding = 1e-12;
  const Tetrahedron reference{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  std::vector<Vec3> sums(rule.size(), Vec3::Zero());
  std::vector<double> counts(rule.size(), 0);
  for_parts(reference, levels, [&](const Vec3& xi) {
    // What is on the border of shares counts for each of them.
    const double least = barycentric_distance(rule[nearest_point(rule, xi)].xi, xi);
    std::vector<std::size_t> owners;
    for (std::size_t q = 0; q < rule.size(); ++q)
      if (barycentric_distance(rule[q].xi, xi) <= least + rounding) owners.push_back(q);
    for (const std::size_t q : owners) {
      sums[q] += xi / static_cast<double>(owners.size());
      counts[q] += 1 / static_cast<double>(owners.size());
    }
  });
  for (std::size_t q = 0; q < rule.size(); ++q) sums[q] /= counts[q];
  return sums;
}

}  // namespace polyslip::remap
