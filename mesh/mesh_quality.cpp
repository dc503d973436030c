// Volumes and shape measures of a mesh's elements.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "mesh/mesh.hpp"
#include "mesh/minimum.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// 1/6 det(b - a, c - a, d - a)
double straight_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).dot((c - a).cross(d - a)) / 6;
}

/// Gradients at the fifteen points, whose rule integrates det J (degree 3) exactly.
struct VolumeRule {
  std::array<QuadraturePoint, 15> points = tet_quadrature_15();
  std::array<std::array<Vec3, 10>, 15> gradients;
  VolumeRule() {
    for (int q = 0; q < 15; ++q) gradients[q] = tet10_gradients(points[q].xi);
  }
};

double element_volume(const Mesh& mesh, int element, const VolumeRule& rule) {
  const auto& t = mesh.tetrahedra[element];
  const Vec3& origin = mesh.nodes[t[0]];
  if (mesh.order == 1)
    return straight_volume(origin, mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]);
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = mesh.nodes[t[i]] - origin;
  double volume = 0;
  for (int q = 0; q < 15; ++q)
    volume += rule.points[q].weight * tet10_jacobian(x, rule.gradients[q]).determinant();
  return volume;
}

}  // namespace

double element_volume(const Mesh& mesh, int element) {
  return element_volume(mesh, element, VolumeRule{});
}

std::vector<double> grain_volumes(const Mesh& mesh, int threads) {
  const VolumeRule rule;
  std::vector<double> volumes(mesh.topology.cell_count(), 0.0);
  const auto& cells = mesh.tetrahedron_cell;
  core::parallel_for(threads, volumes.size(), [&](std::size_t g) {
    const auto [first, last] = std::equal_range(cells.begin(), cells.end(), static_cast<int>(g));
    for (auto at = first; at != last; ++at)
      volumes[g] += element_volume(mesh, static_cast<int>(at - cells.begin()), rule);
  });
  return volumes;
}

// With u, v, w the edges from d: R = |u^2 (v x w) + v^2 (w x u) + w^2 (u x v)| / (2 det), r = 3 V /
// A and V = det / 6. The sign of det is kept, so that an inverted tetrahedron is below a flat one.
double radius_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d, v = b - d, w = c - d;
  const Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double six_volumes = -u.dot(vw);
  const double area = 0.5 * (vw.norm() + wu.norm() + uv.norm() + (b - a).cross(c - a).norm());
  const double circle = (u.squaredNorm() * vw + v.squaredNorm() * wu + w.squaredNorm() * uv).norm();
  if (area == 0 || circle == 0) return 0;
  return 3 * six_volumes * std::abs(six_volumes) / (area * circle);
}

QualitySummary quality(const Mesh& mesh) {
  QualitySummary summary{std::numeric_limits<double>::infinity(), 0};
  if (mesh.tetrahedra.empty()) return {};
  for (const auto& t : mesh.tetrahedra) {
    const double rho =
        radius_ratio(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]);
    summary.min_radius_ratio = min_or_nan(summary.min_radius_ratio, rho);
    summary.mean_radius_ratio += rho / mesh.element_count();
  }
  return summary;
}

}  // namespace polyslip::mesh
