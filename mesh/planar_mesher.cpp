#include "mesh/planar_mesher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/planar_triangulation.hpp"

namespace polyslip::mesh {

namespace {

using Eigen::Vector2d;

/// A triangle is fit if R / (h / sqrt 3) is below this (the equilateral one has 1).
constexpr double fit_ratio = 1.35;
/// Least distances of a new point, in its size h: from points, from the polygon.
constexpr double point_distance = 0.65, boundary_distance = 0.4;
constexpr int smoothing_passes = 6;

double circumradius(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  const double area2 = u[0] * v[1] - u[1] * v[0];
  if (!(area2 > 0)) return std::numeric_limits<double>::infinity();
  return u.norm() * v.norm() * (c - b).norm() / (2 * area2);
}

/// Of a triangle of positive area.
Vector2d circumcentre(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  const double d = 2 * (u[0] * v[1] - u[1] * v[0]);
  const double uu = u.squaredNorm(), vv = v.squaredNorm();
  return a + Vector2d(v[1] * uu - u[1] * vv, u[0] * vv - v[0] * uu) / d;
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d u = b - a;
  const double s = std::clamp((p - a).dot(u) / u.squaredNorm(), 0.0, 1.0);
  return (p - a - s * u).norm();
}

/// Plane <-> integer grid.
struct Grid {
  Vector2d origin;
  double scale;  ///< grid units a unit length

  explicit Grid(const std::vector<Vector2d>& points) {
    Vector2d low = points[0], high = points[0];
    for (const auto& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    origin = (low + high) / 2;
    scale = std::ldexp(1.0, 27) / std::max((high - low).maxCoeff(), 1e-300);
  }
  GridPoint of(const Vector2d& x) const { return of_units((x - origin) * scale); }
  std::vector<GridPoint> of(const std::vector<Vector2d>& points) const {
    std::vector<GridPoint> result;
    for (const auto& x : points) result.push_back(of(x));
    return result;
  }
  static GridPoint of_units(const Vector2d& x) { return {std::llround(x[0]), std::llround(x[1])}; }
};

Vector2d units(const GridPoint& p) { return {static_cast<double>(p.x), static_cast<double>(p.y)}; }

/// Works in grid units.
class Refiner {
 public:
  Refiner(const PlanarProblem& problem, const Grid& grid, const std::vector<GridPoint>& polygon)
      : mesh_(polygon),
        element_size_(problem.element_size * grid.scale),
        growth_(std::log(problem.progression_factor)) {
    for (const auto& p : polygon) x_.push_back(units(p));
    for (double s : problem.sizes) h_.push_back(std::min(s * grid.scale, element_size_));
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t) update(static_cast<int>(t));
  }

  void run() {
    refine();
    for (int pass = 0; pass < smoothing_passes; ++pass) {
      smooth();
      const bool flipped = mesh_.make_delaunay();
      if (pass == smoothing_passes / 2 && flipped) refine_again();
    }
  }

  PlanarTriangulation& mesh() { return mesh_; }
  const std::vector<Vector2d>& points() const { return x_; }

 private:
  int boundary_count() const { return mesh_.boundary_count(); }

  /// Size at x: c_l, or what grows from the boundary nodes.
  double size_at(const Vector2d& x) const {
    double h = element_size_;
    for (int i = 0; i < boundary_count(); ++i)
      if (h_[i] < h) h = std::min(h, h_[i] + growth_ * (x - x_[i]).norm());
    return h;
  }

  void update(int triangle) {
    if (triangle >= static_cast<int>(ratio_.size())) {
      ratio_.resize(triangle + 1);
      stuck_.resize(triangle + 1);
    }
    const auto& v = mesh_.triangles()[triangle].v;
    const double h = (h_[v[0]] + h_[v[1]] + h_[v[2]]) / 3;
    ratio_[triangle] = circumradius(x_[v[0]], x_[v[1]], x_[v[2]]) * std::sqrt(3.0) / h;
    stuck_[triangle] = false;
  }

  bool is_front(int neighbour) const { return neighbour < 0 || ratio_[neighbour] < fit_ratio; }

  /// The unfit triangle beside the front with the largest ratio; -1 if there is none.
  int next_triangle() const {
    int best = -1, best_off_front = -1;
    for (int t = 0; t < static_cast<int>(ratio_.size()); ++t) {
      if (ratio_[t] < fit_ratio || stuck_[t]) continue;
      const auto& n = mesh_.triangles()[t].n;
      const bool front = is_front(n[0]) || is_front(n[1]) || is_front(n[2]);
      int& slot = front ? best : best_off_front;
      if (slot < 0 || ratio_[t] > ratio_[slot]) slot = t;
    }
    return best >= 0 ? best : best_off_front;
  }

  /// Rebay's point: on the bisector of the shortest front edge, so that the new triangle has the
  /// circumradius that its size asks for.
  Vector2d frontal_point(int triangle) const {
    const auto& t = mesh_.triangles()[triangle];
    const Vector2d centre = circumcentre(x_[t.v[0]], x_[t.v[1]], x_[t.v[2]]);
    int side = -1;
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double length = (x_[t.v[(i + 1) % 3]] - x_[t.v[(i + 2) % 3]]).norm();
      if (is_front(t.n[i]) && length < shortest) side = i, shortest = length;
    }
    if (side < 0) return centre;
    const Vector2d &a = x_[t.v[(side + 1) % 3]], &b = x_[t.v[(side + 2) % 3]];
    const Vector2d middle = (a + b) / 2;
    const double p = shortest / 2, q = (centre - middle).norm();
    if (!(q > 0)) return centre;
    const double wanted = size_at(middle) / std::sqrt(3.0);
    const double rho = std::min(std::max(wanted, p), (p * p + q * q) / (2 * q));
    const double d = rho + std::sqrt(std::max(0.0, rho * rho - p * p));
    const Vector2d normal = Vector2d(a[1] - b[1], b[0] - a[0]).normalized();
    return middle + normal * d;
  }

  bool try_insert(const Vector2d& wanted, int start) {
    if (!(wanted.cwiseAbs().maxCoeff() < 0x1p27)) return false;
    const GridPoint point = Grid::of_units(wanted);
    const int triangle = mesh_.locate(point, start);
    if (triangle < 0) return false;
    const Vector2d x = units(point);
    const double h = size_at(x);
    for (const auto& y : x_)
      if ((x - y).squaredNorm() < point_distance * point_distance * h * h) return false;
    for (int i = 0, j = boundary_count() - 1; i < boundary_count(); j = i++)
      if (distance_to_segment(x, x_[j], x_[i]) < boundary_distance * h) return false;
    x_.push_back(x);
    h_.push_back(h);
    std::vector<int> changed;
    mesh_.insert(point, triangle, changed);
    for (int t : changed) update(t);
    return true;
  }

  void refine() {
    for (int t = next_triangle(); t >= 0; t = next_triangle()) {
      const auto& v = mesh_.triangles()[t].v;
      const Vector2d centre = circumcentre(x_[v[0]], x_[v[1]], x_[v[2]]);
      const Vector2d middle = (x_[v[0]] + x_[v[1]] + x_[v[2]]) / 3;
      if (!try_insert(frontal_point(t), t) && !try_insert(centre, t) && !try_insert(middle, t))
        stuck_[t] = true;
    }
  }

  void refine_again() {
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t) update(static_cast<int>(t));
    refine();
  }

  /// Sum of rho^-2 over the triangles around a point; infinite if one is not positive.
  double badness(const std::vector<int>& star) const {
    double sum = 0;
    for (int t : star) {
      const auto& v = mesh_.triangles()[t].v;
      const double rho = radius_ratio(x_[v[0]], x_[v[1]], x_[v[2]]);
      if (!(rho > 1e-9)) return std::numeric_limits<double>::infinity();
      sum += 1 / (rho * rho);
    }
    return sum;
  }

  /// Moves each inner point towards the mean of its neighbours, if that makes its triangles better.
  void smooth() {
    std::vector<std::vector<int>> stars(x_.size());
    for (int t = 0; t < static_cast<int>(mesh_.triangles().size()); ++t)
      for (int v : mesh_.triangles()[t].v) stars[v].push_back(t);
    for (int i = boundary_count(); i < static_cast<int>(x_.size()); ++i) {
      Vector2d mean = Vector2d::Zero();
      for (int t : stars[i])
        for (int v : mesh_.triangles()[t].v) mean += x_[v];
      mean = (mean - static_cast<double>(stars[i].size()) * x_[i]) / (2.0 * stars[i].size());
      const Vector2d from = x_[i];
      double best = badness(stars[i]);
      for (double step : {1.0, 0.5, 0.25}) {
        x_[i] = units(Grid::of_units(from + step * (mean - from)));
        const double value = badness(stars[i]);
        if (value < best) {
          best = value;
          break;
        }
        x_[i] = from;
      }
      mesh_.move(i, Grid::of_units(x_[i]));
    }
  }

  PlanarTriangulation mesh_;
  double element_size_, growth_;
  std::vector<Vector2d> x_;    ///< points in grid units
  std::vector<double> h_;      ///< size at each point
  std::vector<double> ratio_;  ///< [triangles] R sqrt 3 / h
  std::vector<char> stuck_;    ///< [triangles] no point can be added
};

bool has_edge(const PlanarTriangulation& triangulation, int a, int b) {
  const auto holds = [](const auto& t, int v) {
    return std::find(t.v.begin(), t.v.end(), v) != t.v.end();
  };
  return std::any_of(triangulation.triangles().begin(), triangulation.triangles().end(),
                     [&](const auto& t) { return holds(t, a) && holds(t, b); });
}

}  // namespace

double radius_ratio(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  const double area2 = u[0] * v[1] - u[1] * v[0];
  const double la = u.norm(), lb = v.norm(), lc = (c - b).norm();
  if (!(la * lb * lc > 0)) return 0;
  return 4 * area2 * std::abs(area2) / (la * lb * lc * (la + lb + lc));
}

std::string boundary_fault(const PlanarProblem& problem) {
  if (problem.boundary.size() < 3) return "its boundary has less than three nodes";
  for (const auto& x : problem.boundary)
    if (!x.allFinite()) return "a node of its boundary is not finite";
  if (!is_simple(Grid(problem.boundary).of(problem.boundary)))
    return "its projected boundary meets itself or turns right";
  return {};
}

bool mesh_polygon(const PlanarProblem& problem, PlanarMesh& mesh) {
  const auto fail = [&](const std::string& why) {
    mesh = {};
    mesh.fault = why;
    return false;
  };
  mesh = {};
  if (const std::string fault = boundary_fault(problem); !fault.empty()) return fail(fault);
  const Grid grid(problem.boundary);
  Refiner refiner(problem, grid, grid.of(problem.boundary));
  refiner.run();
  auto& triangulation = refiner.mesh();
  for (const auto& [a, b] : problem.forbidden_edges)
    if (!triangulation.split_edge(a, b) && !triangulation.split_edge(b, a) &&
        has_edge(triangulation, a, b))
      return fail("an inner edge between nodes of its boundary is too flat to be cut");
  mesh.points = problem.boundary;
  for (std::size_t i = problem.boundary.size(); i < triangulation.points().size(); ++i)
    mesh.points.push_back(grid.origin + units(triangulation.points()[i]) / grid.scale);
  for (const auto& t : triangulation.triangles()) {
    mesh.triangles.push_back(t.v);
    if (!(radius_ratio(mesh.points[t.v[0]], mesh.points[t.v[1]], mesh.points[t.v[2]]) > 0))
      return fail("a triangle of its mesh has no positive area");
  }
  return true;
}

}  // namespace polyslip::mesh
