#include "mesh/projection.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

Vec3 area_vector(const FaceShape& shape, const Vec3& scale, const std::array<int, 3>& p) {
  const Vec3 a = shape.points[p[0]].cwiseProduct(scale), b = shape.points[p[1]].cwiseProduct(scale);
  const Vec3 c = shape.points[p[2]].cwiseProduct(scale);
  return (b - a).cross(c - a) / 2;
}

double surface_area(const FaceShape& shape, const Vec3& scale, const std::array<int, 3>& p) {
  return area_vector(shape, scale, p).norm();
}

double signed_area(const std::vector<Vector2d>& x, const std::array<int, 3>& p) {
  const Vector2d u = x[p[1]] - x[p[0]], v = x[p[2]] - x[p[0]];
  return (u[0] * v[1] - u[1] * v[0]) / 2;
}

}  // namespace

FaceProjection::FaceProjection(const FaceShape& shape, const Vec3& scale, const Vec3& isotropy)
    : shape_(&shape), scale_(scale), isotropy_(isotropy) {
  Vec3 sum = Vec3::Zero();
  const auto at = [&](int i) -> Vec3 { return shape.points[i].cwiseProduct(isotropy); };
  for (const auto& t : shape.triangles) sum += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])) / 2;
  normal_ = sum.normalized();
  int smallest = 0;
  normal_.cwiseAbs().minCoeff(&smallest);
  first_ = normal_.cross(Vec3::Unit(smallest)).normalized();
  second_ = normal_.cross(first_);
  // The plane's axes in the frame of sizes, made orthonormal there: D (first, second) = axes
  // metric.
  const Vec3 d = scale.cwiseQuotient(isotropy);
  const Vec3 u = d.cwiseProduct(first_), v = d.cwiseProduct(second_);
  axes_.col(0) = u.normalized();
  const double along = axes_.col(0).dot(v);
  const Vec3 across = v - along * axes_.col(0);
  axes_.col(1) = across.normalized();
  if (scale != isotropy) metric_ << u.norm(), along, 0, across.norm();
  for (const auto& x : shape.points) projected_.push_back(project(x));
  find_boxes();
}

FaceProjection::FaceProjection(const FaceShape& shape, const Vec3& scale,
                               std::vector<Vector2d> places)
    : shape_(&shape),
      scale_(scale),
      isotropy_(scale),
      mean_plane_(false),
      projected_(std::move(places)),
      total_share_(0) {
  if (projected_.empty()) return;
  find_boxes();
  find_boundary();
  double flat = 0, area = 0;
  for (const auto& t : shape.triangles)
    for (const auto& q : quarters) {
      const std::array<int, 3> p{t[q[0]], t[q[1]], t[q[2]]};
      const double a = surface_area(shape, scale, p);
      area += a;
      flat += signed_area(projected_, p);
    }
  total_share_ = flat / area;
}

void FaceProjection::find_boxes() {
  for (const auto& t : shape_->triangles) {
    Box box{projected_[t[0]], projected_[t[0]]};
    for (int i : t) {
      box.low = box.low.cwiseMin(projected_[i]);
      box.high = box.high.cwiseMax(projected_[i]);
    }
    const double margin = extrapolation * (box.high - box.low).maxCoeff();
    boxes_.push_back({box.low.array() - margin, box.high.array() + margin});
  }
}

void FaceProjection::find_boundary() {
  std::map<std::array<int, 2>, BoundarySegment> open;
  for (const auto& t : shape_->triangles)
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      const std::array<int, 2> key{std::min(a, b), std::max(a, b)};
      const auto [at, added] = open.try_emplace(key, BoundarySegment{a, t[3 + i], b});
      if (!added) open.erase(at);
    }
  for (const auto& [key, segment] : open) boundary_.push_back(segment);
}

Vector2d FaceProjection::project(const Vec3& position) const {
  if (!mean_plane_) return project_boundary(position);
  const Vec3 x = position.cwiseProduct(isotropy_);
  return metric_ * Vector2d(x.dot(first_), x.dot(second_));
}

// The nearest point of the boundary's quadratic segments: the best of some on each, then Newton's
// method for the distance.
Vector2d FaceProjection::project_boundary(const Vec3& position) const {
  constexpr int samples = 8, iterations = 20;
  double best = std::numeric_limits<double>::infinity();
  Vector2d result = Vector2d::Zero();
  const auto shape = [](double t) {
    return std::array<double, 3>{(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)};
  };
  for (const auto& s : boundary_) {
    const Vec3 a = shape_->points[s.first] - position, m = shape_->points[s.mid] - position,
               b = shape_->points[s.last] - position;
    const auto at = [&](double t) -> Vec3 {
      const auto n = shape(t);
      return n[0] * a + n[1] * m + n[2] * b;
    };
    double t = 0, near = a.squaredNorm();
    for (int i = 1; i <= samples; ++i) {
      const double u = static_cast<double>(i) / samples, d = at(u).squaredNorm();
      if (d < near) near = d, t = u;
    }
    for (int i = 0; i < iterations; ++i) {
      const Vec3 x = at(t), d1 = (4 * t - 3) * a + (4 - 8 * t) * m + (4 * t - 1) * b;
      const Vec3 d2 = 4 * a - 8 * m + 4 * b;
      const double curvature = d1.squaredNorm() + x.dot(d2);
      if (!(curvature > 0)) break;
      const double next = std::clamp(t - x.dot(d1) / curvature, 0.0, 1.0);
      if (std::abs(next - t) < 1e-15) break;
      t = next;
    }
    const double distance = at(t).squaredNorm();
    if (!(distance < best)) continue;
    best = distance;
    const auto n = shape(t);
    result = n[0] * projected_[s.first] + n[1] * projected_[s.mid] + n[2] * projected_[s.last];
  }
  return result;
}

double FaceProjection::area_share(const std::array<int, 3>& p) const {
  if (!mean_plane_)
    return signed_area(projected_, p) / (total_share_ * surface_area(*shape_, scale_, p));
  const Vec3 area = area_vector(*shape_, isotropy_, p);
  return area.dot(normal_) / area.norm();
}

bool FaceProjection::projects(double share) const {
  if (!(total_share_ > 0)) return false;
  for (const auto& t : shape_->triangles)
    for (const auto& q : quarters)
      if (!(area_share({t[q[0]], t[q[1]], t[q[2]]}) > share)) return false;
  return true;
}

double FaceProjection::distortion() const {
  double worst = 0;
  for (const auto& t : shape_->triangles)
    for (const auto& q : quarters) {
      const Vec3 area = area_vector(*shape_, isotropy_, {t[q[0]], t[q[1]], t[q[2]]});
      worst = std::max(worst, std::atan2(area.cross(normal_).norm(), area.dot(normal_)));
    }
  return worst;
}

FaceProjection::Descent FaceProjection::descent(const Vector2d& p, const Vec3& gradient) const {
  if (mean_plane_) {
    const Vector2d g = axes_.transpose() * gradient;
    return {-g / g.norm(), g.norm()};
  }
  // dx/dp by differences, in the frame of sizes.
  const double h = 1e-6 * extent();
  const Vec3 x = lift(p);
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << (lift(p + Vector2d(h, 0)) - x).cwiseProduct(scale_) / h,
      (lift(p + Vector2d(0, h)) - x).cwiseProduct(scale_) / h;
  const Eigen::Matrix2d metric = tangents.transpose() * tangents;
  if (!(metric.determinant() > 1e-12 * metric.squaredNorm())) return {};
  const Vector2d dp = metric.inverse() * (tangents.transpose() * gradient);
  const double slope = (tangents * dp).norm();
  return {-dp / slope, slope};
}

Vec3 FaceProjection::evaluate(int triangle, const Vector2d& xi) const {
  const auto n = tri6_shape(xi[0], xi[1]);
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 6; ++i) x += n[i] * shape_->points[shape_->triangles[triangle][i]];
  return x;
}

Vector2d FaceProjection::place(int triangle, const Vector2d& xi) const {
  const auto n = tri6_shape(xi[0], xi[1]);
  Vector2d x = Vector2d::Zero();
  for (int i = 0; i < 6; ++i) x += n[i] * projected_[shape_->triangles[triangle][i]];
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
    const Vector2d inside = clamped(xi);
    const double d = (place(t, inside) - p).norm();
    if (d < distance) distance = d, nearest = evaluate(t, inside);
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

// Gauss-Newton steps with the tangents of the surface by differences; a step that leads away from
// the target, or farther beyond the face, ends it.
Vec3 FaceProjection::nearest(const Vec3& target, Vector2d& p, double* beyond) const {
  constexpr int steps = 4;
  constexpr double difference = 1e-4;  // of the distance
  double now_beyond = 0;
  Vec3 x = lift(p, &now_beyond);
  const double first = (x - target).norm();
  const double h = difference * (mean_plane_ ? first * scale_.maxCoeff() : 1e-2 * extent());
  for (int i = 0; i < steps && first > 0; ++i) {
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << (lift(p + Vector2d(h, 0)) - x) / h, (lift(p + Vector2d(0, h)) - x) / h;
    const Eigen::Matrix2d metric = tangents.transpose() * tangents;
    if (!(std::abs(metric.determinant()) > 1e-12 * metric.squaredNorm())) break;
    const Vector2d step = metric.inverse() * (tangents.transpose() * (target - x));
    double next_beyond = 0;
    const Vec3 next = lift(p + step, &next_beyond);
    if (!(next_beyond <= now_beyond)) break;
    if (!((next - target).norm() < (1 - 1e-6) * (x - target).norm())) break;
    p += step;
    x = next;
    now_beyond = next_beyond;
  }
  if (beyond) *beyond = now_beyond;
  return x;
}

}  // namespace polyslip::mesh
