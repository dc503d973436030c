#include "mesh/domain_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "mesh/topology.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using std::numbers::pi;

/// The plane that touches the ellipsoid x_i = extents_i / 2 (1 + y_i), |y| = 1, at the direction y.
Plane tangent(const Vec3& y, const Vec3& extents) {
  const Vec3 half = extents / 2;
  const Vec3 normal = y.cwiseQuotient(half).normalized();
  return {normal, normal.dot(half + half.cwiseProduct(y))};
}

double prism_excess(int sides) { return sides * std::tan(pi / sides) / pi - 1; }

std::vector<Vec3> icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (const double s : {-1.0, 1.0})
      for (const double g : {-golden, golden}) {
        Vec3 x = Vec3::Zero();
        x[(axis + 1) % 3] = s;
        x[(axis + 2) % 3] = g;
        corners.push_back(x);
      }
  return corners;
}

void add_new(std::vector<Vec3>& points, const Vec3& x) {
  for (const Vec3& p : points)
    if ((p - x).norm() < 1e-6) return;
  points.push_back(x);
}

/// Points of a triangular lattice on the faces of an icosahedron, one side of which is h steps
/// along a row and k along the next, put on the sphere: 10 (h^2 + h k + k^2) + 2 points, all with
/// six neighbours but for the 12 corners (Goldberg, Tohoku Math. J. 43, 1937, 104).
std::vector<Vec3> geodesic(int h, int k) {
  const auto corners = icosahedron();
  const int n = h * h + h * k + k * k;
  std::vector<Vec3> points;
  const auto neighbours = [&](const Vec3& p, const Vec3& q) {
    return std::abs((p - q).norm() - 2) < 1e-6;
  };
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t b = a + 1; b < corners.size(); ++b)
      for (std::size_t c = b + 1; c < corners.size(); ++c) {
        Vec3 p = corners[a], q = corners[b], r = corners[c];
        if (!neighbours(p, q) || !neighbours(q, r) || !neighbours(r, p)) continue;
        if (p.dot(q.cross(r)) < 0) std::swap(q, r);
        // Lattice point (i, j) = u (h, k) + v (-k, h + k), in the triangle if u, v, 1 - u - v >= 0.
        for (int i = -k; i <= h; ++i)
          for (int j = 0; j <= h + k; ++j) {
            const int u = i * (h + k) + j * k, v = j * h - i * k;
            if (u < 0 || v < 0 || u + v > n) continue;
            add_new(points, ((n - u - v) * p + u * q + v * r).normalized());
          }
      }
  return points;
}

/// The lattices (h, k), coarsest first.
std::vector<std::array<int, 2>> lattices(int finest) {
  std::vector<std::array<int, 2>> all;
  for (int h = 1; h <= finest; ++h)
    for (int k = 0; k <= h; ++k) all.push_back({h, k});
  const auto number = [](const std::array<int, 2>& l) {
    return l[0] * l[0] + l[0] * l[1] + l[1] * l[1];
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& p, const auto& q) { return number(p) < number(q); });
  return all;
}

Domain sphere_of(const std::vector<Vec3>& points, const Vec3& extents, double volume) {
  std::vector<Plane> planes;
  for (const Vec3& y : points) planes.push_back(tangent(y, extents));
  return convex_domain("sphere", planes, std::vector<std::string>(points.size(), "surface"),
                       volume);
}

/// Moves each point towards the centroid of the facet that touches the sphere there.
void even_out(std::vector<Vec3>& points) {
  const Domain sphere = sphere_of(points, Vec3::Constant(2), 0);
  const Vec3 centre = Vec3::Ones() - sphere.origin;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& loop = sphere.faces[i].loop;
    Vec3 moment = Vec3::Zero();
    double area = 0;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const Vec3 &a = sphere.vertices[loop[0]], &b = sphere.vertices[loop[k]],
                 &c = sphere.vertices[loop[k + 1]];
      const double part = (b - a).cross(c - a).norm();
      area += part;
      moment += part * (a + b + c) / 3;
    }
    points[i] = (moment / area - centre).normalized();
  }
}

double surface_area(const Domain& domain) {
  double area = 0;
  const auto& x = domain.vertices;
  for (const auto& face : domain.faces)
    for (std::size_t k = 1; k + 1 < face.loop.size(); ++k) {
      const Vec3& origin = x[face.loop[0]];
      area += (x[face.loop[k]] - origin).cross(x[face.loop[k + 1]] - origin).norm() / 2;
    }
  return area;
}

}  // namespace

Domain cylinder_domain(const Vec3& extents, int axis, double error, double volume) {
  int sides = 6;
  while (prism_excess(sides) > error) ++sides;
  std::vector<Plane> planes;
  std::vector<std::string> names;
  for (int end = 0; end < 2; ++end) {
    planes.push_back({Vec3::Unit(axis) * (end ? 1.0 : -1.0), end ? extents[axis] : 0.0});
    names.push_back(box_face_names[2 * axis + end]);
  }
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    Vec3 y = Vec3::Zero();
    y[(axis + 1) % 3] = std::cos(angle);
    y[(axis + 2) % 3] = std::sin(angle);
    planes.push_back(tangent(y, extents));
    names.push_back("side");
  }
  Domain domain = convex_domain("cylinder", planes, names, volume);
  domain.faceting_error = prism_excess(sides);
  domain.facet_size =
      (domain.size[(axis + 1) % 3] + domain.size[(axis + 2) % 3]) / 2 * std::tan(pi / sides);
  return domain;
}

Domain sphere_domain(const Vec3& extents, double error, double volume) {
  const double true_volume = pi / 6 * extents.prod();
  constexpr int finest = 30;
  for (const auto& [h, k] : lattices(finest)) {
    // A hexagonal facet of N exceeds the sphere by about 3.1/N of its share.
    if (3.0 / (10 * (h * h + h * k + k * k) + 2) > error) continue;
    auto points = geodesic(h, k);
    for (int i = 0; i < 5; ++i) even_out(points);
    const double excess = sphere_of(points, extents, 0).volume / true_volume - 1;
    if (excess > error) continue;
    Domain domain = sphere_of(points, extents, volume);
    domain.faceting_error = excess;
    domain.facet_size = std::sqrt(surface_area(domain) / static_cast<double>(points.size()));
    return domain;
  }
  throw core::InputError(fmt::format("faceting_error = {}: too small for a sphere", error));
}

}  // namespace polyslip::mesh
