#include "mesh/edge_removal.hpp"

#include <algorithm>
#include <limits>

#include "mesh/minimum.hpp"

namespace polyslip::mesh {
namespace {

using Tet = TetStore::Tet;

/// Klincsek's dynamic programme over the ring's polygon: best[i][j] is the largest least radius
/// ratio over the triangulations of nodes i ... j, by the triangle i, apex[i][j], j. Entries that
/// do not pass `bound` are -infinity, as no triangulation with them can win.
class RingTriangulation {
 public:
  RingTriangulation(const TetStore& store, const EdgeRing& ring, double bound)
      : store_(store), ring_(ring) {
    constexpr double none = -std::numeric_limits<double>::infinity();
    for (int i = 0; i + 1 < ring.count; ++i)
      best_[i][i + 1] = std::numeric_limits<double>::infinity();
    for (int span = 2; span < ring.count; ++span)
      for (int i = 0; i + span < ring.count; ++i) {
        const int j = i + span;
        best_[i][j] = none;
        for (int k = i + 1; k < j; ++k) {
          const double least = std::max(bound, best_[i][j]);
          const double parts = std::min(best_[i][k], best_[k][j]);
          if (!(parts > least)) continue;
          const double all = std::min(parts, triangle_quality(i, k, j, least));
          if (!(all > least)) continue;
          best_[i][j] = all;
          apex_[i][j] = k;
        }
      }
  }

  bool found() const { return best_[0][ring_.count - 1] > 0; }

  void apply(TetStore& store, int i, int j) const {
    if (j - i < 2) return;
    const int k = apex_[i][j];
    store.add(over(i, k, j));
    store.add(under(i, k, j));
    apply(store, i, k);
    apply(store, k, j);
  }

 private:
  Tet over(int i, int k, int j) const {
    return {ring_.nodes[i], ring_.nodes[k], ring_.nodes[j], ring_.b};
  }
  Tet under(int i, int k, int j) const {
    return {ring_.nodes[i], ring_.nodes[j], ring_.nodes[k], ring_.a};
  }
  /// Exact only if it is above `least`.
  double triangle_quality(int i, int k, int j, double least) const {
    const double first = store_.quality_of(over(i, k, j));
    if (!(first > least)) return first;
    return min_or_nan(first, store_.quality_of(under(i, k, j)));
  }

  const TetStore& store_;
  const EdgeRing& ring_;
  std::array<std::array<double, max_ring>, max_ring> best_;
  std::array<std::array<int, max_ring>, max_ring> apex_;
};

}  // namespace

bool remove_edge(TetStore& store, int a, int b, double gain) {
  EdgeRing ring;
  if (!store.ring(a, b, ring)) return false;
  double old = std::numeric_limits<double>::infinity();
  for (int i = 0; i < ring.count; ++i) old = min_or_nan(old, store.quality(ring.tets[i]));
  const RingTriangulation triangulation(store, ring, std::max(0.0, old) + gain);
  if (!triangulation.found()) return false;
  for (int i = 0; i < ring.count; ++i) store.remove(ring.tets[i]);
  triangulation.apply(store, 0, ring.count - 1);
  return true;
}

bool flip_facet(TetStore& store, int t, int i, double gain) {
  const int s = store.neighbour(t, i);
  if (s < 0) return false;
  const Tet own = store.tet(t);
  const int j = (i + 1) % 4;
  const auto& others = even_permutations[i][j];
  // (p, facet) is positive, so that (p, facet[k], facet[k + 1], q) is where p-q cuts the facet.
  const int p = own[i];
  const std::array<int, 3> facet{own[j], own[others[0]], own[others[1]]};
  int q = -1;
  for (const int n : store.tet(s))
    if (n != facet[0] && n != facet[1] && n != facet[2]) q = n;
  const double bound = std::max(0.0, min_or_nan(store.quality(t), store.quality(s))) + gain;
  std::array<Tet, 3> tets;
  for (int k = 0; k < 3; ++k) {
    tets[k] = {p, facet[k], facet[(k + 1) % 3], q};
    if (!(store.quality_of(tets[k]) > bound)) return false;
  }
  store.remove(t);
  store.remove(s);
  for (const Tet& fresh : tets) store.add(fresh);
  return true;
}

}  // namespace polyslip::mesh
