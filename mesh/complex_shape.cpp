#include "mesh/complex_shape.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "mesh/face_fan.hpp"

namespace polyslip::mesh {
namespace {

using core::Mat3;
using core::Vec3;

/// Weight of the distance to where the vertex is against that to one plane, squared.
constexpr double towards_old_position = 1e-4;

/// Weight of a face's plane in the Voronoi tessellation against its mean plane, squared distances.
constexpr double first_plane_weight = 0.5;

/// Least squares of distances to planes n . x = n . x_old + d, in the directions that the vertex's
/// domain faces leave free.
class PlaneFit {
 public:
  PlaneFit(const CellComplex& complex, int vertex)
      : old_(complex.vertex(vertex).position), planes_(complex.planes_at(vertex)) {
    matrix_ = towards_old_position * Mat3::Identity();
  }

  void add(const Vec3& normal, double distance, double weight = 1) {
    matrix_ += weight * normal * normal.transpose();
    residual_ += weight * normal * distance;
  }

  Vec3 position() const {
    if (planes_.empty()) return old_ + matrix_.ldlt().solve(residual_);
    const Directions free = free_directions(planes_);
    if (free.count == 0) return old_;
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> basis(3, free.count);
    for (int i = 0; i < free.count; ++i) basis.col(i) = free[i];
    Vec3 x =
        old_ +
        basis * (basis.transpose() * matrix_ * basis).ldlt().solve(basis.transpose() * residual_);
    put_on_planes(planes_, x);
    return x;
  }

 private:
  Vec3 old_;
  std::vector<Plane> planes_;
  Mat3 matrix_;
  Vec3 residual_ = Vec3::Zero();
};

/// The fan triangles of a cell's faces, turned outwards, in the frame of the cell.
template <class Visit>
void for_each_triangle(const CellComplex& complex, int cell, Visit&& visit) {
  for (const int f : complex.cell(cell).faces) {
    const auto& face = complex.face(f);
    const auto points = complex.loop_points(f);
    if (face.cells[0] == cell) for_each_fan_triangle(points, face.master, visit);
    if (face.cells[1] != cell) continue;
    const Vec3 step = complex.step(f);
    for_each_fan_triangle(points, face.master, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
      visit(b + step, a + step, m + step);
    });
  }
}

bool seen_from_centroid(const CellComplex& complex, int cell) {
  const Vec3 origin = complex.seed(cell);
  double volume = 0;
  Vec3 moment = Vec3::Zero();
  for_each_triangle(complex, cell, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
    const Vec3 p = a - origin, q = b - origin, r = m - origin;
    const double part = p.dot(q.cross(r));
    volume += part;
    moment += part * (p + q + r) / 4;
  });
  if (!(volume > 0)) return false;
  const Vec3 centroid = origin + moment / volume;
  bool seen = true;
  for_each_triangle(complex, cell, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
    if (!((a - centroid).dot((b - centroid).cross(m - centroid)) > 0)) seen = false;
  });
  return seen;
}

}  // namespace

Vec3 least_squares_position(const CellComplex& complex, int vertex, const std::vector<int>& faces) {
  PlaneFit fit(complex, vertex);
  for (const int f : faces) {
    if (complex.face(f).domain_face >= 0) continue;
    const Plane& plane = complex.plane(f);
    fit.add(plane.normal, plane.offset - plane.normal.dot(complex.position_in(f, vertex)));
  }
  return fit.position();
}

Vec3 flattest_position(const CellComplex& complex, int vertex, const std::vector<int>& faces) {
  PlaneFit fit(complex, vertex);
  for (const int f : faces) {
    if (complex.face(f).domain_face >= 0) continue;
    const auto points = complex.loop_points(f);
    const auto vertices = complex.loop_vertices(f);
    const Vec3 normal = vector_area(points).normalized();
    Vec3 others = Vec3::Zero();
    Vec3 here = Vec3::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
      (vertices[i] == vertex ? here : others) += points[i];
    fit.add(normal, normal.dot(others / static_cast<double>(points.size() - 1) - here));
    const Plane& plane = complex.plane(f);
    fit.add(plane.normal, plane.offset - plane.normal.dot(here), first_plane_weight);
  }
  return fit.position();
}

double fit_faces(CellComplex& complex, const std::vector<int>& faces) {
  double worst = 0;
  for (const int f : faces) {
    const auto points = complex.loop_points(f);
    const BestFan fan = best_fan(points);
    complex.set_fan(f, fan.master, fan.fault);
    worst = std::max(worst, fan.fault);
    if (!(vector_area(points).dot(complex.plane(f).normal) > 0) ||
        !unfolded_in_projection(points, fan.master))
      return std::numeric_limits<double>::infinity();
  }
  return worst;
}

bool cells_sound(const CellComplex& complex, int vertex) {
  for (const int c : complex.cells_at(vertex))
    if (c >= 0 && !seen_from_centroid(complex, c)) return false;
  return true;
}

}  // namespace polyslip::mesh
