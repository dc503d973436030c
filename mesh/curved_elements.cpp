#include "mesh/curved_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/error.hpp"
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
  explicit Mender(Mesh& mesh)
      : mesh_(mesh), gradients_(watched_points()), mids_(mesh.nodes.size()) {
    for (const auto& t : mesh.tetrahedra)
      for (int e = 0; e < 6; ++e)
        set(t[tetrahedron_edges[e][0]], t[tetrahedron_edges[e][1]], t[4 + e]);
    for (const auto& t : mesh.triangles)
      for (int k = 3; k < 6; ++k) mids_[t[k]].on_surface = true;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto& t = mesh.tetrahedra[e];
      if (std::any_of(t.begin() + 4, t.end(), [&](int n) { return mids_[n].curved; }))
        watched_.push_back(e);
    }
  }

  int run() {
    auto bad = unfit(watched_);
    if (bad.empty()) return 0;
    find_rings();
    for (int sweep = 0; sweep < 2 && !bad.empty(); ++sweep) {
      for (int e : bad) follow(e);
      bad = unfit(bad);
    }
    for (bad = unfit(watched_); !bad.empty(); bad = unfit(watched_))
      for (int e : bad) pull_in_best(e);
    return static_cast<int>(std::count_if(
        mids_.begin(), mids_.end(), [](const MidNode& m) { return m.on_surface && m.pulls > 0; }));
  }

 private:
  struct MidNode {
    Vec3 chord = Vec3::Zero(), bulge = Vec3::Zero();  ///< position = chord + bulge
    int pulls = 0;
    bool curved = false, on_surface = false;
  };

  void set(int a, int b, int mid) {
    const Vec3 chord = (mesh_.nodes[a] + mesh_.nodes[b]) / 2, bulge = mesh_.nodes[mid] - chord;
    mids_[mid].chord = chord;
    mids_[mid].bulge = bulge;
    mids_[mid].curved = bulge.norm() > 1e-12 * (mesh_.nodes[b] - mesh_.nodes[a]).norm();
  }

  std::vector<int> unfit(const std::vector<int>& elements) const {
    std::vector<int> list;
    for (int e : elements)
      if (!(least_ratio_of(mesh_, mesh_.tetrahedra[e], gradients_) >= least_ratio))
        list.push_back(e);
    return list;
  }

  /// Elements around each mid node.
  void find_rings() {
    rings_.resize(mesh_.nodes.size());
    for (int e = 0; e < mesh_.element_count(); ++e)
      for (int i = 4; i < 10; ++i) rings_[mesh_.tetrahedra[e][i]].push_back(e);
  }

  double worst_around(int mid) const {
    double worst = std::numeric_limits<double>::infinity();
    for (int e : rings_[mid])
      worst = min_or_nan(worst, least_ratio_of(mesh_, mesh_.tetrahedra[e], gradients_));
    return worst;
  }

  /// Gives inner mid nodes of an element a part of the bulge of the curved mid nodes around them,
  /// if that makes the worst element around better.
  void follow(int element) {
    for (int i = 4; i < 10; ++i) {
      const int mid = mesh_.tetrahedra[element][i];
      if (mids_[mid].on_surface) continue;
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for (int e : rings_[mid])
        for (int k = 4; k < 10; ++k) {
          const int other = mesh_.tetrahedra[e][k];
          if (other == mid || !mids_[other].curved) continue;
          sum += mids_[other].bulge;
          ++count;
        }
      if (count == 0) continue;
      const Vec3 mean = sum / count;
      Vec3 best = mids_[mid].bulge;
      double best_worst = worst_around(mid);
      for (double part : {0.25, 0.5, 0.75, 1.0}) {
        mesh_.nodes[mid] = mids_[mid].chord + part * mean;
        const double worst = worst_around(mid);
        if (worst > best_worst) best_worst = worst, best = part * mean;
      }
      if (best != mids_[mid].bulge && !mids_[mid].curved) {
        mids_[mid].curved = true;
        for (int e : rings_[mid]) watched_.push_back(e);
      }
      mids_[mid].bulge = best;
      mesh_.nodes[mid] = mids_[mid].chord + best;
    }
    std::sort(watched_.begin(), watched_.end());
    watched_.erase(std::unique(watched_.begin(), watched_.end()), watched_.end());
  }

  /// Pulls the curved mid node of an element that helps it most; all of them if none does. Each is
  /// pulled a bounded number of times; an element that is straight and still unfit ends it.
  void pull_in_best(int element) {
    const auto& t = mesh_.tetrahedra[element];
    double best_ratio = least_ratio_of(mesh_, t, gradients_);
    int best = -1;
    for (int i = 4; i < 10; ++i) {
      const MidNode& m = mids_[t[i]];
      if (!m.curved) continue;
      mesh_.nodes[t[i]] = m.chord + pull * m.bulge;
      const double ratio = least_ratio_of(mesh_, t, gradients_);
      mesh_.nodes[t[i]] = m.chord + m.bulge;
      if (ratio > best_ratio) best_ratio = ratio, best = t[i];
    }
    if (best >= 0) return pull_in(best);
    if (std::none_of(t.begin() + 4, t.end(), [&](int n) { return mids_[n].curved; }))
      throw core::RecoverableError(
          fmt::format("element {} of grain {} has no positive volume even with straight edges "
                      "(ratio of Jacobians {})",
                      element + 1, mesh_.tetrahedron_cell[element] + 1, best_ratio));
    for (int i = 4; i < 10; ++i)
      if (mids_[t[i]].curved) pull_in(t[i]);
  }

  void pull_in(int mid) {
    auto& m = mids_[mid];
    m.curved = ++m.pulls < pulls;
    m.bulge = m.curved ? Vec3(pull * m.bulge) : Vec3::Zero();
    mesh_.nodes[mid] = m.chord + m.bulge;
  }

  Mesh& mesh_;
  std::vector<std::array<Vec3, 10>> gradients_;
  std::vector<MidNode> mids_;            ///< [nodes]
  std::vector<int> watched_;             ///< elements with a curved mid node, sorted
  std::vector<std::vector<int>> rings_;  ///< [nodes]
};

}  // namespace

double least_jacobian_ratio(const Mesh& mesh, int element) {
  return least_ratio_of(mesh, mesh.tetrahedra[element], watched_points());
}

int mend_curved_elements(Mesh& mesh) { return mesh.order == 1 ? 0 : Mender(mesh).run(); }

}  // namespace polyslip::mesh
