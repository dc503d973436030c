#include "mesh/projection.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;
using Eigen::Vector2d;

/// A six-node triangle in four straight ones.
constexpr std::array<std::array<int, 3>, 4> quarters{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
/// How far beyond a triangle its own shape goes on (least barycentric coordinate).
constexpr double extrapolation = 0.2;

double least_coordinate(const Vector2d& xi) { return std::min({xi[0], xi[1], 1 - xi[0] - xi[1]}); }

/// Barycentric coordinates that are negative set to zero, the others to a sum of one.
Vector2d clamped(const Vector2d& xi) {
  const Vec3 l = Vec3(1 - xi[0] - xi[1], xi[0], xi[1]).cwiseMax(0);
  return Vector2d(l[1], l[2]) / l.sum();
}

}  // namespace

FaceProjection::FaceProjection(const FaceShape& shape, const Vec3& scale)
    : shape_(&shape), scale_(scale) {
  Vec3 sum = Vec3::Zero();
  const auto at = [&](int i) -> Vec3 { return shape.points[i].cwiseProduct(scale); };
  for (const auto& t : shape.triangles) sum += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])) / 2;
  normal_ = sum.normalized();
  int smallest = 0;
  normal_.cwiseAbs().minCoeff(&smallest);
  first_ = normal_.cross(Vec3::Unit(smallest)).normalized();
  second_ = normal_.cross(first_);
  for (const auto& x : shape.points) projected_.push_back(project(x));
  for (const auto& t : shape.triangles) {
    Box box{projected_[t[0]], projected_[t[0]]};
    for (int i : t) {
      box.low = box.low.cwiseMin(projected_[i]);
      box.high = box.high.cwiseMax(projected_[i]);
    }
    const double margin = extrapolation * (box.high - box.low).maxCoeff();
    boxes_.push_back({box.low.array() - margin, box.high.array() + margin});
  }
}

Vector2d FaceProjection::project(const Vec3& position) const {
  const Vec3 x = position.cwiseProduct(scale_);
  return {x.dot(first_), x.dot(second_)};
}

bool FaceProjection::projects(double share) const {
  for (const auto& t : shape_->triangles)
    for (const auto& q : quarters) {
      const Vec3 a = shape_->points[t[q[0]]].cwiseProduct(scale_);
      const Vec3 b = shape_->points[t[q[1]]].cwiseProduct(scale_);
      const Vec3 c = shape_->points[t[q[2]]].cwiseProduct(scale_);
      const Vec3 area = (b - a).cross(c - a);
      if (!(area.dot(normal_) > share * area.norm())) return false;
    }
  return true;
}

double FaceProjection::distortion() const {
  double worst = 0;
  for (const auto& t : shape_->triangles)
    for (const auto& q : quarters) {
      const Vec3 a = shape_->points[t[q[0]]].cwiseProduct(scale_);
      const Vec3 b = shape_->points[t[q[1]]].cwiseProduct(scale_);
      const Vec3 c = shape_->points[t[q[2]]].cwiseProduct(scale_);
      const Vec3 area = (b - a).cross(c - a);
      worst = std::max(worst, std::atan2(area.cross(normal_).norm(), area.dot(normal_)));
    }
  return worst;
}

Vec3 FaceProjection::evaluate(int triangle, const Vector2d& xi) const {
  const auto n = tri6_shape(xi[0], xi[1]);
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 6; ++i) x += n[i] * shape_->points[shape_->triangles[triangle][i]];
  return x;
}

double FaceProjection::invert(int triangle, const Vector2d& p, Vector2d& xi) const {
  const auto& t = shape_->triangles[triangle];
  const double none = -std::numeric_limits<double>::infinity();
  Eigen::Matrix2d straight;
  straight << projected_[t[1]] - projected_[t[0]], projected_[t[2]] - projected_[t[0]];
  const double size = straight.squaredNorm();
  if (!(std::abs(straight.determinant()) > 1e-12 * size)) return none;
  xi = straight.inverse() * (p - projected_[t[0]]);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const auto n = tri6_shape(xi[0], xi[1]);
    const auto g = tri6_gradients(xi[0], xi[1]);
    Vector2d residual = -p;
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 6; ++i) {
      residual += n[i] * projected_[t[i]];
      jacobian += projected_[t[i]] * Eigen::RowVector2d(g[i][0], g[i][1]);
    }
    if (!(jacobian.determinant() > 1e-6 * straight.determinant())) return none;
    const Vector2d step = jacobian.inverse() * residual;
    xi -= step;
    if (!(xi.cwiseAbs().maxCoeff() < 3)) return none;
    if (step.cwiseAbs().maxCoeff() < 1e-12) return least_coordinate(xi);
  }
  return none;
}

double FaceProjection::extent() const {
  Vector2d low = projected_.front(), high = low;
  for (const auto& p : projected_) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

Vec3 FaceProjection::lift(const Vector2d& p, double* beyond) const {
  if (beyond) *beyond = 0;
  const int count = static_cast<int>(shape_->triangles.size());
  int best = -1;
  Vector2d best_xi = Vector2d::Zero();
  double best_inside = -std::numeric_limits<double>::infinity();
  const auto attempt = [&](int t) {
    Vector2d xi;
    const double inside = invert(t, p, xi);
    if (inside > best_inside) best = t, best_inside = inside, best_xi = xi;
  };
  for (int t = 0; t < count && best_inside < 0; ++t)
    if ((p.array() >= boxes_[t].low.array()).all() && (p.array() <= boxes_[t].high.array()).all())
      attempt(t);
  if (best_inside >= -extrapolation) return evaluate(best, best_xi);
  // Beyond every triangle: the nearest point of the nearest one, by its clamped coordinates.
  Vec3 nearest = Vec3::Zero();
  double distance = std::numeric_limits<double>::infinity();
  for (int t = 0; t < count; ++t) {
    Vector2d xi;
    if (!std::isfinite(invert(t, p, xi))) continue;
    const Vec3 x = evaluate(t, clamped(xi));
    const double d = (project(x) - p).norm();
    if (d < distance) distance = d, nearest = x;
  }
  // No triangle can be inverted: the nearest node.
  if (!std::isfinite(distance))
    for (std::size_t i = 0; i < projected_.size(); ++i)
      if ((projected_[i] - p).norm() < distance) {
        distance = (projected_[i] - p).norm();
        nearest = shape_->points[i];
      }
  if (beyond) *beyond = distance;
  return nearest;
}

// Gauss-Newton steps with the tangents of the surface by differences; a step that leads away ends
// it.
Vec3 FaceProjection::nearest(const Vec3& target, const Vector2d& start, double* beyond) const {
  constexpr int steps = 4;
  constexpr double difference = 1e-4;  // of the distance
  Vector2d p = start;
  Vec3 x = lift(p, beyond);
  const double first = (x - target).norm();
  if (!(first > 0)) return x;
  const double h = difference * first * scale_.maxCoeff();
  for (int i = 0; i < steps; ++i) {
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << (lift(p + Vector2d(h, 0)) - x) / h, (lift(p + Vector2d(0, h)) - x) / h;
    const Eigen::Matrix2d metric = tangents.transpose() * tangents;
    if (!(std::abs(metric.determinant()) > 1e-12 * metric.squaredNorm())) break;
    const Vector2d step = metric.inverse() * (tangents.transpose() * (target - x));
    double next_beyond = 0;
    const Vec3 next = lift(p + step, &next_beyond);
    if (!((next - target).norm() < (1 - 1e-6) * (x - target).norm())) break;
    p += step;
    x = next;
    if (beyond) *beyond = next_beyond;
  }
  return x;
}

}  // namespace polyslip::mesh
