#include <cmath>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

// With a, b, c the edges from d: R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (2 det), r = 3 V /
// A and V = det / 6. The sign of det is kept, so that an inverted tetrahedron is below a flat one.
double radius_ratio(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c,
                    const core::Vec3& d) {
  const core::Vec3 u = a - d, v = b - d, w = c - d;
  const core::Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double six_volumes = -u.dot(vw);
  const double area = 0.5 * (vw.norm() + wu.norm() + uv.norm() + (b - a).cross(c - a).norm());
  const double circle = (u.squaredNorm() * vw + v.squaredNorm() * wu + w.squaredNorm() * uv).norm();
  if (area == 0 || circle == 0) return 0;
  return 3 * six_volumes * std::abs(six_volumes) / (area * circle);
}

}  // namespace polyslip::mesh
