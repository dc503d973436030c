#include "mesh/node_relocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"
#include "mesh/minimum.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Tet = TetStore::Tet;

constexpr int halvings = 5;
constexpr double longest_step = 0.3;  // share of the least distance to a neighbour
constexpr int split_relocations = 5;
/// A new node in the middle of an edge is relocated only if it starts above this share.
constexpr double split_start = 0.3;

struct Descent {
  double sum = 0, least = std::numeric_limits<double>::infinity(), reach = least;
  Vec3 gradient = Vec3::Zero();
};

Descent descent(const TetStore& store, int node, int power) {
  Descent d;
  const Vec3& x = store.position(node);
  for (const int t : store.star(node)) {
    const Tet& tet = store.tet(t);
    const int i = corner_of(tet, node), j = (i + 1) % 4;
    const Vec3& p = store.position(tet[j]);
    const Vec3& q = store.position(tet[even_permutations[i][j][0]]);
    const Vec3& r = store.position(tet[even_permutations[i][j][1]]);
    const double value = barrier(store.quality(t), power);
    d.sum += value;
    d.gradient -= power * value * log_radius_ratio_gradient(x, p, q, r);
    d.least = min_or_nan(d.least, store.quality(t));
    d.reach = std::min({d.reach, (x - p).norm(), (x - q).norm(), (x - r).norm()});
  }
  return d;
}

/// Whether the star with the node at x has a lesser sum and no element below `d.least`.
bool improves(const TetStore& store, int node, const Vec3& x, const Descent& d, int power) {
  double sum = 0;
  for (const int t : store.star(node)) {
    std::array<const Vec3*, 4> corners{};
    for (int i = 0; i < 4; ++i)
      corners[i] = store.tet(t)[i] == node ? &x : &store.position(store.tet(t)[i]);
    const double rho = radius_ratio(*corners[0], *corners[1], *corners[2], *corners[3]);
    if (!(rho >= d.least)) return false;
    sum += barrier(rho, power);
    if (!(sum < d.sum)) return false;
  }
  return true;
}

double ring_quality(const TetStore& store, const EdgeRing& ring) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < ring.count; ++i) least = min_or_nan(least, store.quality(ring.tets[i]));
  return least;
}

std::vector<int> neighbours_of(const TetStore& store, int node) {
  std::vector<int> nodes;
  for (const int t : store.star(node))
    for (const int n : store.tet(t))
      if (n != node) nodes.push_back(n);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Least radius ratio of the tetrahedra that are left of node's star when it goes onto `target`;
/// exact only if it is above `bound`.
double collapsed_quality(const TetStore& store, int node, int target, double bound) {
  double least = std::numeric_limits<double>::infinity();
  for (const int t : store.star(node)) {
    Tet tet = store.tet(t);
    if (corner_of(tet, target) >= 0) continue;
    tet[corner_of(tet, node)] = target;
    least = min_or_nan(least, store.quality_of(tet));
    if (!(least > bound)) break;
  }
  return least;
}

}  // namespace

// With u, v, w the edges from p, k = u^2 (v x w) + v^2 (w x u) + w^2 (u x v) and D = u . (v x w):
// ln rho = 2 ln D - ln A - ln |k| + const, each by u.
Vec3 log_radius_ratio_gradient(const Vec3& x, const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 u = x - p, v = q - p, w = r - p, s = w - v;
  const Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v), side = (u - v).cross(s);
  const double det = u.dot(vw), n1 = uv.norm(), n2 = wu.norm(), n3 = side.norm();
  const Vec3 k = u.squaredNorm() * vw + v.squaredNorm() * wu + w.squaredNorm() * uv;
  const Vec3 by_area = v.cross(uv) / n1 + wu.cross(w) / n2 + s.cross(side) / n3;
  const Vec3 by_circle =
      2 * k.dot(vw) * u + v.squaredNorm() * k.cross(w) + w.squaredNorm() * v.cross(k);
  return 2 / det * vw - by_area / (n1 + n2 + n3 + vw.norm()) - by_circle / k.squaredNorm();
}

bool relocate(TetStore& store, int node, int power) {
  const Descent d = descent(store, node, power);
  const double slope = d.gradient.norm();
  if (!(slope > 0) || !std::isfinite(slope)) return false;
  // The sum would reach that of regular elements at (sum - count) / slope, were it linear.
  const auto count = static_cast<double>(store.star(node).size());
  double step = std::min(longest_step * d.reach, (d.sum - count) / slope);
  for (int i = 0; i <= halvings; ++i, step /= 2) {
    const Vec3 x = store.position(node) - step / slope * d.gradient;
    if (!improves(store, node, x, d, power)) continue;
    store.move(node, x);
    return true;
  }
  return false;
}

bool split_edge(TetStore& store, int a, int b, double gain) {
  EdgeRing ring;
  if (!store.ring(a, b, ring)) return false;
  const double old = ring_quality(store, ring);
  std::vector<Tet> before, after;
  const int node = store.add_node(0.5 * (store.position(a) + store.position(b)));
  bool good = true;
  for (int i = 0; i < ring.count; ++i) {
    const int p = ring.nodes[i], q = ring.nodes[(i + 1) % ring.count];
    before.push_back(store.tet(ring.tets[i]));
    for (const Tet& t : {Tet{a, node, p, q}, Tet{node, b, p, q}}) {
      after.push_back(t);
      good &= store.quality_of(t) > split_start * std::max(old, 0.0);
    }
  }
  if (!good) return false;
  for (int i = 0; i < ring.count; ++i) store.remove(ring.tets[i]);
  for (const Tet& t : after) store.add(t);
  for (int i = 0; i < split_relocations && relocate(store, node); ++i) {
  }
  if (store.star_quality(node) > old + gain) return true;
  const std::vector<int> star = store.star(node);
  for (const int t : star) store.remove(t);
  for (const Tet& t : before) store.add(t);
  return false;
}

bool collapse_node(TetStore& store, int node, double gain) {
  if (!store.is_free(node)) return false;
  double best = std::max(0.0, store.star_quality(node)) + gain;
  int target = -1;
  for (const int n : neighbours_of(store, node)) {
    const double quality = collapsed_quality(store, node, n, best);
    if (!(quality > best)) continue;
    best = quality;
    target = n;
  }
  if (target < 0) return false;
  const std::vector<int> star = store.star(node);
  for (const int t : star) {
    Tet tet = store.tet(t);
    store.remove(t);
    if (corner_of(tet, target) >= 0) continue;
    tet[corner_of(tet, node)] = target;
    store.add(tet);
  }
  return true;
}

}  // namespace polyslip::mesh
