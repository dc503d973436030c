#include "mesh/face_mesher.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "mesh/quality_criterion.hpp"

namespace polyslip::mesh {

namespace {

using Eigen::Vector2d;

constexpr double highest_floor = 0.3;
constexpr double corner_share = 0.7;
constexpr double floor_steps = 10;
constexpr double area_rounding = 1e-10;  // of the polygon's area

double twice_area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  return u[0] * v[1] - u[1] * v[0];
}

double twice_area(const std::vector<Vector2d>& polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += twice_area(polygon[0], polygon[i - 1], polygon[i]);
  return sum;
}

std::string check_points(const PlanarProblem& problem, const PlanarMesh& mesh) {
  const auto& boundary = problem.boundary;
  if (mesh.triangles.empty()) return "no triangles";
  if (mesh.points.size() < boundary.size()) return "boundary nodes are missing";
  for (std::size_t i = 0; i < boundary.size(); ++i)
    if (std::memcmp(boundary[i].data(), mesh.points[i].data(), 2 * sizeof(double)) != 0)
      return fmt::format("boundary node {} has moved", i);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (!mesh.points[i].allFinite()) return fmt::format("node {} is not finite", i);
  const int count = static_cast<int>(mesh.points.size());
  std::vector<bool> used(mesh.points.size(), false);
  for (const auto& t : mesh.triangles)
    for (const int n : t) {
      if (n < 0 || n >= count) return fmt::format("a triangle has node {} of {}", n, count);
      used[n] = true;
    }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) return fmt::format("node {} is unused", unused - used.begin());
  return {};
}

/// Every directed edge once; its reverse too, but for those of the boundary.
std::string check_edges(const PlanarProblem& problem, const PlanarMesh& mesh) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end())
    return "two triangles on one side of an edge";
  const auto has = [&](int a, int b) {
    return std::binary_search(edges.begin(), edges.end(), std::array<int, 2>{a, b});
  };
  const int n = static_cast<int>(problem.boundary.size());
  int open = 0;
  for (const auto& [a, b] : edges) {
    if (has(b, a)) continue;
    if (a >= n || b != (a + 1) % n) return "the boundary is not kept";
    ++open;
  }
  if (open != n) return fmt::format("{} of {} boundary edges are kept", open, n);
  for (const auto& [a, b] : problem.forbidden_edges)
    if (has(a, b)) return fmt::format("nodes {} and {} are joined by an edge", a, b);
  return {};
}

std::string check_areas(const PlanarProblem& problem, const PlanarMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const double area = twice_area(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    if (!(area > 0)) return fmt::format("triangle {} has no positive area", i);
    sum += area;
  }
  const double wanted = twice_area(problem.boundary);
  if (!(std::abs(sum - wanted) <= area_rounding * wanted))
    return fmt::format("its triangles have the area {:.6g} of {:.6g}", sum / 2, wanted / 2);
  return {};
}

/// Triangle and corner opposite to the directed edge (a, b); {-1, 0} if there is none.
std::array<int, 2> opposite(const PlanarMesh& mesh, int a, int b) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (mesh.triangles[t][(i + 1) % 3] == a && mesh.triangles[t][(i + 2) % 3] == b)
        return {static_cast<int>(t), i};
  return {-1, 0};
}

}  // namespace

std::string validate(const PlanarProblem& problem, const PlanarMesh& mesh) {
  std::string fault = check_points(problem, mesh);
  if (fault.empty()) fault = check_edges(problem, mesh);
  if (fault.empty()) fault = check_areas(problem, mesh);
  return fault;
}

bool split_forbidden_edges(const PlanarProblem& problem, PlanarMesh& mesh) {
  for (const auto& [a, b] : problem.forbidden_edges) {
    const auto [left, i] = opposite(mesh, a, b);
    const auto [right, j] = opposite(mesh, b, a);
    if (left < 0 || right < 0) continue;
    const int c = mesh.triangles[left][i], d = mesh.triangles[right][j];
    const Vector2d m = (mesh.points[a] + mesh.points[b]) / 2;
    const auto positive = [&](int from, int to) {
      return twice_area(mesh.points[from], mesh.points[to], m) > 0;
    };
    if (!positive(c, a) || !positive(b, c) || !positive(d, b) || !positive(a, d)) return false;
    const int n = static_cast<int>(mesh.points.size());
    mesh.points.push_back(m);
    mesh.triangles[left] = {c, a, n};
    mesh.triangles[right] = {d, b, n};
    mesh.triangles.push_back({b, c, n});
    mesh.triangles.push_back({a, d, n});
  }
  return true;
}

double min_radius_ratio(const PlanarMesh& mesh) {
  double least = mesh.triangles.empty() ? 0 : 1;
  for (const auto& t : mesh.triangles)
    least = std::min(least, radius_ratio(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
  return least;
}

double mesh_quality_O(const PlanarMesh& mesh, double element_size) {
  QualityCriterion criterion(element_size);
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    criterion.add(radius_ratio(a, b, c), ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3);
  }
  return criterion.value();
}

double worst_triangle_floor(const PlanarProblem& problem) {
  // A triangle with an angle w has 2 r/R = 8 sin(w/2) sin(u/2) sin(v/2), at most with u = v.
  const auto& x = problem.boundary;
  const std::size_t n = x.size();
  double least = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d u = x[(i + 1) % n] - x[i], v = x[(i + n - 1) % n] - x[i];
    const double angle = std::atan2(u[0] * v[1] - u[1] * v[0], u.dot(v));
    if (angle <= 0 || angle >= M_PI / 3) continue;
    const double s = std::sin(angle / 2);
    least = std::min(least, 4 * s * (1 - s));
  }
  return std::min(highest_floor, corner_share * least);
}

void FaceCandidates::offer(std::size_t mesher, PlanarMesh&& mesh) {
  if (!mesh.fault.empty()) return;
  const double least = min_radius_ratio(mesh);
  const int steps = static_cast<int>(std::floor(floor_steps * std::min(least / floor_, 1.0)));
  const double O = mesh_quality_O(mesh, element_size_);
  const auto rank = [](int w, double o, std::size_t m) { return std::tuple(-w, -o, m); };
  if (any_ && rank(steps_, O_, mesher_) <= rank(steps, O, mesher)) return;
  any_ = true;
  mesher_ = mesher;
  steps_ = steps;
  least_ = least;
  O_ = O;
  mesh_ = std::move(mesh);
}

}  // namespace polyslip::mesh
