#include "mesh/curved_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/error.hpp"
#include "mesh/blocks.hpp"
#include "mesh/curvature_bound.hpp"
#include "mesh/minimum.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

constexpr double least_ratio = 0.1;  ///< of det J to that of the straight element
constexpr double pull = 0.75;        ///< what is left of a bulge that is pulled in
constexpr int pulls = 16;            ///< after so many (1 %) a mid node is put on its chord

/// Gradients where det J is looked at: quadrature points of both rules and the nodes.
std::vector<std::array<Vec3, 10>> watched_points() {
  std::vector<std::array<Vec3, 10>> gradients;
  for (const auto& q : tet_quadrature_4()) gradients.push_back(tet10_gradients(q.xi));
  for (const auto& q : tet_quadrature_15()) gradients.push_back(tet10_gradients(q.xi));
  const std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (const auto& c : corners) gradients.push_back(tet10_gradients(c));
  for (const auto& [a, b] : tetrahedron_edges)
    gradients.push_back(tet10_gradients((corners[a] + corners[b]) / 2));
  return gradients;
}

double least_ratio_of(const Mesh& mesh, const std::array<int, 10>& t,
                      const std::vector<std::array<Vec3, 10>>& gradients) {
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = mesh.nodes[t[i]] - mesh.nodes[t[0]];
  const double straight = x[1].dot(x[2].cross(x[3]));
  if (!(straight > 0)) return std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& g : gradients) least = min_or_nan(least, tet10_jacobian(x, g).determinant());
  return least / straight;
}

class Mender {
 public:
  Mender(Mesh& mesh, int threads)
      : mesh_(mesh),
        threads_(threads),
        gradients_(watched_points()),
        curved_(mesh.nodes.size(), false),
        on_surface_(mesh.nodes.size(), false) {
    for (const auto& t : mesh.triangles)
      for (int k = 3; k < 6; ++k) on_surface_[t[k]] = true;
    for_blocks(threads, mesh.tetrahedra.size(), [this](std::size_t first, std::size_t last) {
      for (std::size_t e = first; e < last; ++e) find_curved(mesh_.tetrahedra[e]);
    });
  }

  int run() {
    auto bad = all_unfit();
    if (bad.empty()) return 0;
    find_rings();
    find_translates();
    for (int sweep = 0; sweep < 2 && !bad.empty(); ++sweep) {
      for (int e : bad) follow(e);
      touched_.insert(touched_.end(), bad.begin(), bad.end());
      bad = unfit(bad);
    }
    for (bad = unfit_of_touched(bad); !bad.empty(); bad = unfit_of_touched(bad))
      for (int e : bad) pull_in_best(e);
    return pulled_on_surface_;
  }

 private:
  /// Of a mid node that may move.
  struct MidNode {
    Vec3 chord = Vec3::Zero(), bulge = Vec3::Zero();  ///< position = chord + bulge
    int pulls = 0;
  };

  Vec3 chord_of(const std::array<int, 10>& t, int k) const {
    return (mesh_.nodes[t[tetrahedron_edges[k][0]]] + mesh_.nodes[t[tetrahedron_edges[k][1]]]) / 2;
  }

  void find_curved(const std::array<int, 10>& t) {
    for (int k = 0; k < 6; ++k) {
      const auto& [i, j] = tetrahedron_edges[k];
      const Vec3 bulge = mesh_.nodes[t[4 + k]] - chord_of(t, k);
      if (bulge.norm() > 1e-12 * (mesh_.nodes[t[j]] - mesh_.nodes[t[i]]).norm())
        std::atomic_ref(curved_[t[4 + k]]).store(true, std::memory_order_relaxed);
    }
  }

  bool is_fit(int e) const {
    // det J is then at least 0.5^3 of the straight element's, all over it.
    return curvature_bound(mesh_, e) <= 0.5 ||
           least_ratio_of(mesh_, mesh_.tetrahedra[e], gradients_) >= least_ratio;
  }

  /// Elements with a curved mid node that are unfit.
  std::vector<int> all_unfit() const {
    std::mutex mutex;
    std::vector<int> list;
    for_blocks(threads_, mesh_.tetrahedra.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const auto& t = mesh_.tetrahedra[i];
        const int e = static_cast<int>(i);
        if (std::none_of(t.begin() + 4, t.end(), [&](int n) { return curved_[n]; }) || is_fit(e))
          continue;
        const std::lock_guard lock(mutex);
        list.push_back(e);
      }
    });
    std::sort(list.begin(), list.end());
    return list;
  }

  std::vector<int> unfit(const std::vector<int>& elements) const {
    std::vector<int> list;
    for (int e : elements)
      if (!is_fit(e)) list.push_back(e);
    return list;
  }

  /// The unfit among elements that were unfit and those around mid nodes that moved since; the
  /// others are as they were.
  std::vector<int> unfit_of_touched(const std::vector<int>& elements) {
    touched_.insert(touched_.end(), elements.begin(), elements.end());
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    const auto list = unfit(touched_);
    touched_.clear();
    return list;
  }

  /// Elements around each mid node.
  void find_rings() {
    ring_first_.assign(mesh_.nodes.size() + 1, 0);
    for (const auto& t : mesh_.tetrahedra)
      for (int i = 4; i < 10; ++i) ++ring_first_[t[i] + 1];
    for (std::size_t i = 1; i < ring_first_.size(); ++i) ring_first_[i] += ring_first_[i - 1];
    rings_.resize(ring_first_.back());
    // Each node's start moves to its end, which is the next one's start.
    for (int e = 0; e < mesh_.element_count(); ++e)
      for (int i = 4; i < 10; ++i) rings_[ring_first_[mesh_.tetrahedra[e][i]]++] = e;
    std::copy_backward(ring_first_.begin(), ring_first_.end() - 1, ring_first_.end());
    ring_first_.front() = 0;
  }

  std::span<const int> ring(int mid) const {
    return {rings_.data() + ring_first_[mid], rings_.data() + ring_first_[mid + 1]};
  }

  MidNode& mid_node(int mid) {
    const auto [at, added] = mids_.try_emplace(mid);
    if (added) {
      const auto& t = mesh_.tetrahedra[ring(mid).front()];
      const auto k = std::find(t.begin() + 4, t.end(), mid) - t.begin() - 4;
      at->second.chord = chord_of(t, static_cast<int>(k));
      at->second.bulge = mesh_.nodes[mid] - at->second.chord;
    }
    return at->second;
  }

  void touch(int mid) {
    const auto elements = ring(mid);
    touched_.insert(touched_.end(), elements.begin(), elements.end());
  }

  void find_translates() {
    if (mesh_.periodic_nodes.empty()) return;
    translates_.resize(mesh_.nodes.size());
    for (std::size_t p = 0; p < mesh_.periodic_nodes.size(); ++p)
      for (const int n : {mesh_.periodic_nodes[p].slave, mesh_.periodic_nodes[p].master})
        translates_[n].push_back(static_cast<int>(p));
  }

  double worst_around(int mid) const {
    double worst = std::numeric_limits<double>::infinity();
    for (int e : ring(mid))
      worst = min_or_nan(worst, least_ratio_of(mesh_, mesh_.tetrahedra[e], gradients_));
    return worst;
  }

  /// Gives inner mid nodes of an element a part of the bulge of the curved mid nodes around them,
  /// if that makes the worst element around better.
  void follow(int element) {
    for (int i = 4; i < 10; ++i) {
      const int mid = mesh_.tetrahedra[element][i];
      if (on_surface_[mid]) continue;
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for (int e : ring(mid))
        for (int k = 4; k < 10; ++k) {
          const int other = mesh_.tetrahedra[e][k];
          if (other == mid || !curved_[other]) continue;
          sum += mid_node(other).bulge;
          ++count;
        }
      if (count == 0) continue;
      const Vec3 mean = sum / count;
      MidNode& m = mid_node(mid);
      Vec3 best = m.bulge;
      double best_worst = worst_around(mid);
      for (double part : {0.25, 0.5, 0.75, 1.0}) {
        mesh_.nodes[mid] = m.chord + part * mean;
        const double worst = worst_around(mid);
        if (worst > best_worst) best_worst = worst, best = part * mean;
      }
      if (best != m.bulge) {
        curved_[mid] = true;
        touch(mid);
      }
      m.bulge = best;
      mesh_.nodes[mid] = m.chord + best;
    }
  }

  /// Pulls the curved mid node of an element that helps it most; all of them if none does. Each is
  /// pulled a bounded number of times; an element that is straight and still unfit ends it.
  void pull_in_best(int element) {
    const auto& t = mesh_.tetrahedra[element];
    double best_ratio = least_ratio_of(mesh_, t, gradients_);
    int best = -1;
    for (int i = 4; i < 10; ++i) {
      if (!curved_[t[i]]) continue;
      const MidNode& m = mid_node(t[i]);
      const Vec3 was = mesh_.nodes[t[i]];
      mesh_.nodes[t[i]] = m.chord + pull * m.bulge;
      const double ratio = least_ratio_of(mesh_, t, gradients_);
      mesh_.nodes[t[i]] = was;
      if (ratio > best_ratio) best_ratio = ratio, best = t[i];
    }
    if (best >= 0) return pull_in(best);
    if (std::none_of(t.begin() + 4, t.end(), [&](int n) { return curved_[n]; }))
      throw core::RecoverableError(
          fmt::format("element {} of grain {} has no positive volume even with straight edges "
                      "(ratio of Jacobians {})",
                      element + 1, mesh_.tetrahedron_cell[element] + 1, best_ratio));
    for (int i = 4; i < 10; ++i)
      if (curved_[t[i]]) pull_in(t[i]);
  }

  /// With its translates, to where theirs are.
  void pull_in(int mid) {
    if (translates_.empty()) return pull_in_one(mid);
    const int master =
        translates_[mid].empty() ? mid : mesh_.periodic_nodes[translates_[mid][0]].master;
    pull_in_one(master);
    for (const int p : translates_[master]) {
      const auto& pair = mesh_.periodic_nodes[p];
      pull_in_one(pair.slave);
      mesh_.nodes[pair.slave] = translated(mesh_.nodes[master], pair.shift, mesh_.size);
    }
  }

  void pull_in_one(int mid) {
    auto& m = mid_node(mid);
    pulled_on_surface_ += m.pulls == 0 && on_surface_[mid];
    curved_[mid] = ++m.pulls < pulls;
    m.bulge = curved_[mid] ? Vec3(pull * m.bulge) : Vec3::Zero();
    mesh_.nodes[mid] = m.chord + m.bulge;
    touch(mid);
  }

  Mesh& mesh_;
  int threads_;
  std::vector<std::array<Vec3, 10>> gradients_;
  std::vector<char> curved_, on_surface_;  ///< [nodes] mid nodes
  std::unordered_map<int, MidNode> mids_;  ///< those looked at; looked up only
  std::vector<std::uint32_t> ring_first_;  ///< [nodes + 1]
  std::vector<int> rings_;                 ///< elements around mid nodes
  std::vector<int> touched_;               ///< elements around mid nodes that moved
  int pulled_on_surface_ = 0;
  /// [nodes] pairs of the node; empty if there are none
  std::vector<std::vector<int>> translates_;
};

}  // namespace

double least_jacobian_ratio(const Mesh& mesh, int element) {
  return least_ratio_of(mesh, mesh.tetrahedra[element], watched_points());
}

int mend_curved_elements(Mesh& mesh, int threads) {
  return mesh.order == 1 ? 0 : Mender(mesh, threads).run();
}

}  // namespace polyslip::mesh
