#include "mesh/flattening.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Eigen::Vector2d;
using Places = std::vector<Vector2d>;
using Triangle = std::array<int, 3>;

/// The face as straight triangles in the scaled frame: quarters of its six-node ones.
struct Surface {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

Surface surface_of(const FaceShape& shape, const Vec3& scale) {
  constexpr std::array<Triangle, 4> quarters{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  Surface s;
  for (const auto& x : shape.points) s.points.push_back(x.cwiseProduct(scale));
  for (const auto& t : shape.triangles)
    for (const auto& q : quarters) s.triangles.push_back({t[q[0]], t[q[1]], t[q[2]]});
  return s;
}

/// Sides that one triangle has, from point to point.
std::map<int, int> boundary_of(const Surface& s) {
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : s.triangles)
    for (int i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  std::map<int, int> next;
  for (const auto& [side, count] : sides)
    if (!sides.contains({side[1], side[0]})) next[side[0]] = side[1];
  return next;
}

/// The same area as the surface.
Places rescaled(const Surface& s, Places places) {
  double flat = 0, area = 0;
  for (const auto& t : s.triangles) {
    const Vector2d u = places[t[1]] - places[t[0]], v = places[t[2]] - places[t[0]];
    flat += (u[0] * v[1] - u[1] * v[0]) / 2;
    area += (s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]).norm() / 2;
  }
  if (!(flat > 0) || !std::isfinite(flat)) return {};
  for (auto& p : places) p *= std::sqrt(area / flat);
  return places;
}

/// The corners' triangles alone.
Surface corner_triangles(const FaceShape& shape, const Vec3& scale) {
  Surface s;
  for (const auto& x : shape.points) s.points.push_back(x.cwiseProduct(scale));
  for (const auto& t : shape.triangles) s.triangles.push_back({t[0], t[1], t[2]});
  return s;
}

double length_of(const Surface& s, const std::vector<int>& loop) {
  double length = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    length += (s.points[loop[(i + 1) % loop.size()]] - s.points[loop[i]]).norm();
  return length;
}

/// The boundary's loops, the longest first; none if loops meet.
std::vector<std::vector<int>> loops_of(const Surface& s) {
  auto next = boundary_of(s);
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    auto& loop = loops.emplace_back();
    int at = next.begin()->first;
    do {
      const auto on = next.find(at);
      if (on == next.end()) return {};
      loop.push_back(at);
      at = on->second;
      next.erase(on);
    } while (at != loop.front());
    if (loop.size() < 3) return {};
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [&](const auto& a, const auto& b) { return length_of(s, a) > length_of(s, b); });
  return loops;
}

/// Lids on all loops but the first: triangles from a new point, amid the loop, to its sides.
void close_holes(const std::vector<std::vector<int>>& loops, Surface& s) {
  for (std::size_t k = 1; k < loops.size(); ++k) {
    const auto& loop = loops[k];
    Vec3 middle = Vec3::Zero();
    for (const int i : loop) middle += s.points[i] / static_cast<double>(loop.size());
    const int lid = static_cast<int>(s.points.size());
    s.points.push_back(middle);
    for (std::size_t i = 0; i < loop.size(); ++i)
      s.triangles.push_back({loop[(i + 1) % loop.size()], loop[i], lid});
  }
}

/// Places of the triangles' points that are not fixed: means of their neighbours' with mean-value
/// weights. False if there are none.
bool place_in_the_mean_of_neighbours(const Surface& s, const std::vector<char>& fixed,
                                     Places& places) {
  const int count = static_cast<int>(s.points.size());
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> sums(count, 0.0);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(count, 2);
  const auto add = [&](int i, int j, double weight) {
    sums[i] += weight;
    if (fixed[j])
      right.row(i) += weight * places[j].transpose();
    else
      entries.emplace_back(i, j, -weight);
  };
  for (const auto& t : s.triangles)
    for (int k = 0; k < 3; ++k) {
      const int i = t[k], p = t[(k + 1) % 3], q = t[(k + 2) % 3];
      if (fixed[i]) continue;
      const Vec3 u = s.points[p] - s.points[i], v = s.points[q] - s.points[i];
      const double half = std::atan2(u.cross(v).norm(), u.dot(v)) / 2;
      add(i, p, std::tan(half) / u.norm());
      add(i, q, std::tan(half) / v.norm());
    }
  for (int i = 0; i < count; ++i) {
    if (fixed[i]) right.row(i) = places[i].transpose();
    entries.emplace_back(i, i, sums[i] > 0 ? sums[i] : 1);  // 1: fixed, or no corner
  }
  Eigen::SparseMatrix<double> a(count, count);
  a.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(a);
  if (solver.info() != Eigen::Success) return false;
  const Eigen::MatrixX2d x = solver.solve(right);
  if (!x.allFinite()) return false;
  for (int i = 0; i < count; ++i) places[i] = x.row(i).transpose();
  return true;
}

/// Two points of the boundary that are far from each other.
std::array<int, 2> far_apart(const Surface& s, const std::map<int, int>& boundary) {
  const auto farthest = [&](int from) {
    int best = from;
    double distance = -1;
    for (const auto& [a, b] : boundary) {
      const double d = (s.points[a] - s.points[from]).squaredNorm();
      if (d > distance) distance = d, best = a;
    }
    return best;
  };
  const int first = farthest(boundary.begin()->first);
  return {first, farthest(first)};
}

}  // namespace

// Cauchy and Riemann's equations on each triangle: with its corners z_j in its own plane and their
// places w_j, both complex, sum_j (z_(j+2) - z_(j+1)) w_j = 0; the sum of their squares over twice
// the area is least, two points being given.
Places conformal_places(const FaceShape& shape, const Vec3& scale) {
  const Surface s = surface_of(shape, scale);
  const auto boundary = boundary_of(s);
  if (boundary.size() < 3) return {};
  const auto [first, second] = far_apart(s, boundary);
  const int count = static_cast<int>(s.points.size());
  std::vector<int> unknown(count, -1);
  int unknowns = 0;
  for (int i = 0; i < count; ++i)
    if (i != first && i != second) unknown[i] = unknowns++;
  Places places(count, Vector2d::Zero());
  places[second][0] = (s.points[second] - s.points[first]).norm();
  const int rows = 2 * static_cast<int>(s.triangles.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
  for (int k = 0; k < rows / 2; ++k) {
    const auto& t = s.triangles[k];
    const Vec3 u = s.points[t[1]] - s.points[t[0]], v = s.points[t[2]] - s.points[t[0]];
    const Vec3 n = u.cross(v);
    if (!(n.norm() > 0)) return {};
    const Vec3 e = u.normalized(), f = n.cross(e).normalized();
    const std::array<Vector2d, 3> z{Vector2d::Zero(), Vector2d(u.norm(), 0),
                                    Vector2d(v.dot(e), v.dot(f))};
    for (int j = 0; j < 3; ++j) {
      const Vector2d w = (z[(j + 2) % 3] - z[(j + 1) % 3]) / std::sqrt(n.norm());
      // (w0 + i w1)(x + i y): real part in row 2 k, imaginary part in the next.
      const std::array<Vector2d, 2> row{Vector2d(w[0], -w[1]), Vector2d(w[1], w[0])};
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c)
          if (const int column = unknown[t[j]]; column >= 0)
            entries.emplace_back(2 * k + r, 2 * column + c, row[r][c]);
          else
            right[2 * k + r] -= row[r][c] * places[t[j]][c];
    }
  }
  Eigen::SparseMatrix<double> a(rows, 2 * unknowns);
  a.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> normal = a.transpose() * a;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::VectorXd x = solver.solve(a.transpose() * right);
  if (!x.allFinite()) return {};
  for (int i = 0; i < count; ++i)
    if (unknown[i] >= 0) places[i] = x.segment<2>(2 * unknown[i]);
  return rescaled(s, std::move(places));
}

Places circle_places(const FaceShape& shape, const Vec3& scale) {
  Surface s = corner_triangles(shape, scale);
  auto loops = loops_of(s);
  if (loops.empty()) return {};
  close_holes(loops, s);
  const int count = static_cast<int>(s.points.size());
  Places places(count, Vector2d::Zero());
  std::vector<char> fixed(count, false);
  const double round = length_of(s, loops.front());
  double along = 0;
  for (std::size_t i = 0; i < loops.front().size(); ++i) {
    const int here = loops.front()[i], next = loops.front()[(i + 1) % loops.front().size()];
    const double angle = 2 * std::numbers::pi * along / round;
    places[here] = Vector2d(std::cos(angle), std::sin(angle));
    fixed[here] = true;
    along += (s.points[next] - s.points[here]).norm();
  }
  if (!place_in_the_mean_of_neighbours(s, fixed, places)) return {};
  places.resize(shape.points.size());
  for (const auto& t : shape.triangles)
    for (int i = 0; i < 3; ++i) places[t[3 + i]] = (places[t[i]] + places[t[(i + 1) % 3]]) / 2;
  return rescaled(surface_of(shape, scale), std::move(places));
}

}  // namespace polyslip::mesh
