#include "mesh/tet_store.hpp"

#include <algorithm>
#include <limits>

#include "mesh/mesh.hpp"
#include "mesh/minimum.hpp"

namespace polyslip::mesh {

TetStore::TetStore(const VolumeMesh& mesh, std::size_t fixed)
    : fixed_(fixed), nodes_(mesh.nodes), stars_(mesh.nodes.size()) {
  tets_.reserve(2 * mesh.tetrahedra.size());
  for (const auto& t : mesh.tetrahedra) add(t);
}

double TetStore::quality_of(const Tet& t) const {
  return radius_ratio(nodes_[t[0]], nodes_[t[1]], nodes_[t[2]], nodes_[t[3]]);
}

double TetStore::star_quality(int node) const {
  double least = std::numeric_limits<double>::infinity();
  for (const int t : stars_[node]) least = min_or_nan(least, quality_[t]);
  return least;
}

int TetStore::neighbour(int t, int i) const {
  const Tet& own = tets_[t];
  const int x = own[(i + 1) % 4], y = own[(i + 2) % 4], z = own[(i + 3) % 4];
  for (const int s : stars_[x])
    if (s != t && corner_of(tets_[s], y) >= 0 && corner_of(tets_[s], z) >= 0) return s;
  return -1;
}

bool TetStore::ring(int a, int b, EdgeRing& ring) const {
  ring.a = a;
  ring.b = b;
  ring.count = 0;
  std::array<int, max_ring> tets, from, to;
  for (const int t : stars_[a]) {
    const int j = corner_of(tets_[t], b);
    if (j < 0) continue;
    if (ring.count == max_ring) return false;
    const auto& others = even_permutations[corner_of(tets_[t], a)][j];
    tets[ring.count] = t;
    from[ring.count] = tets_[t][others[0]];
    to[ring.count] = tets_[t][others[1]];
    ++ring.count;
  }
  if (ring.count < 3) return false;
  for (int i = 0, at = 0; i < ring.count; ++i) {
    ring.tets[i] = tets[at];
    ring.nodes[i] = from[at];
    const int* next = std::find(from.data(), from.data() + ring.count, to[at]);
    at = static_cast<int>(next - from.data());
    const bool last = i + 1 == ring.count;
    // Open on the surface; or two fans that meet in the edge.
    if (at == ring.count || (at == 0) != last) return false;
  }
  return true;
}

int TetStore::add(const Tet& t) {
  const int number = slot_count();
  tets_.push_back(t);
  quality_.push_back(quality_of(t));
  for (const int n : t) stars_[n].push_back(number);
  return number;
}

void TetStore::remove(int t) {
  for (const int n : tets_[t]) std::erase(stars_[n], t);
  tets_[t][0] = -1;
}

int TetStore::add_node(const core::Vec3& x) {
  nodes_.push_back(x);
  stars_.emplace_back();
  return node_count() - 1;
}

void TetStore::move(int node, const core::Vec3& x) {
  nodes_[node] = x;
  for (const int t : stars_[node]) quality_[t] = quality_of(tets_[t]);
}

VolumeMesh TetStore::mesh() const {
  VolumeMesh result;
  std::vector<int> number(nodes_.size(), -1);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (n >= fixed_ && stars_[n].empty()) continue;
    number[n] = static_cast<int>(result.nodes.size());
    result.nodes.push_back(nodes_[n]);
  }
  for (int t = 0; t < slot_count(); ++t) {
    if (!alive(t)) continue;
    Tet renumbered{};
    for (int i = 0; i < 4; ++i) renumbered[i] = number[tets_[t][i]];
    result.tetrahedra.push_back(renumbered);
  }
  return result;
}

}  // namespace polyslip::mesh
