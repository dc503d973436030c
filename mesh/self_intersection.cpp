#include "mesh/self_intersection.hpp"

#include <algorithm>

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// Sign of det(b - a, c - a, d - a), in extended precision.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long x = a.cast<long double>();
  const Long u = b.cast<long double>() - x, v = c.cast<long double>() - x;
  const Long w = d.cast<long double>() - x;
  const long double det = u.dot(v.cross(w));
  return (det > 0) - (det < 0);
}

/// Whether the segment pq runs through the inside of the triangle abc.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (side(a, b, c, p) * side(a, b, c, q) >= 0) return false;
  const int s = side(p, q, a, b);
  return s != 0 && side(p, q, b, c) == s && side(p, q, c, a) == s;
}

struct Box {
  Vec3 low, high;
  bool meets(const Box& o) const {
    return (low.array() <= o.high.array()).all() && (o.low.array() <= high.array()).all();
  }
};

}  // namespace

std::vector<int> intersecting_triangles(const SurfaceMesh& surface) {
  const auto& x = surface.nodes;
  const auto& triangles = surface.triangles;
  std::vector<Box> boxes;
  for (const auto& t : triangles)
    boxes.push_back(
        {x[t[0]].cwiseMin(x[t[1]]).cwiseMin(x[t[2]]), x[t[0]].cwiseMax(x[t[1]]).cwiseMax(x[t[2]])});
  std::vector<int> found;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t j = 0; j < triangles.size(); ++j) {
      if (i == j || !boxes[i].meets(boxes[j])) continue;
      const auto &t = triangles[i], &o = triangles[j];
      for (int k = 0; k < 3; ++k) {
        const int p = t[k], q = t[(k + 1) % 3];
        if (std::find(o.begin(), o.end(), p) != o.end()) continue;
        if (std::find(o.begin(), o.end(), q) != o.end()) continue;
        if (!pierces(x[p], x[q], x[o[0]], x[o[1]], x[o[2]])) continue;
        found.push_back(static_cast<int>(i));
        found.push_back(static_cast<int>(j));
      }
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace polyslip::mesh
