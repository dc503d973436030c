#include "mesh/common_plane.hpp"

#include <algorithm>
#include <limits>

namespace polyslip::mesh {

using core::Vec3;

std::optional<CommonPlane> common_plane(const Vec3& own, const Vec3& area,
                                        std::span<const Vec3> points, double rounding) {
  for (const Vec3& normal : {own, Vec3(area.normalized())}) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& x : points) {
      low = std::min(low, normal.dot(x));
      high = std::max(high, normal.dot(x));
    }
    if (high - low <= rounding) return CommonPlane{normal, low, high};
  }
  return std::nullopt;
}

double plane_rounding(const Vec3& size) {
  constexpr double flat = 1e-10;
  return flat * size.maxCoeff();
}

}  // namespace polyslip::mesh
