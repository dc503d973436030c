#pragma once
// Tetrahedra of one grain that local operations take away and add, with the tetrahedra around each
// node and each tetrahedron's radius ratio.

#include <array>
#include <cstddef>
#include <vector>

#include "core/types.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Longest ring of tetrahedra around an edge that the optimiser looks at.
inline constexpr int max_ring = 8;

/// The `count` tetrahedra around an inner edge a-b and the nodes around it: tetrahedron i is
/// (a, b, nodes[i], nodes[i + 1 mod count]), positive.
struct EdgeRing {
  int a = 0, b = 0, count = 0;
  std::array<int, max_ring> tets{}, nodes{};
};

class TetStore {
 public:
  using Tet = std::array<int, 4>;

  /// Nodes [0, fixed) belong to the surface and never move or go.
  TetStore(const VolumeMesh& mesh, std::size_t fixed);

  /// Numbers of tetrahedra are below this; those taken away leave their number unused.
  int slot_count() const { return static_cast<int>(tets_.size()); }
  bool alive(int t) const { return tets_[t][0] >= 0; }
  const Tet& tet(int t) const { return tets_[t]; }
  double quality(int t) const { return quality_[t]; }
  int node_count() const { return static_cast<int>(nodes_.size()); }
  /// Inside the grain and in use.
  bool is_free(int node) const { return node >= static_cast<int>(fixed_) && !stars_[node].empty(); }
  const core::Vec3& position(int node) const { return nodes_[node]; }
  /// Tetrahedra that have the node.
  const std::vector<int>& star(int node) const { return stars_[node]; }

  /// Radius ratio of a tetrahedron, in the store or not; negative if it is inverted.
  double quality_of(const Tet& t) const;
  /// Least radius ratio of the tetrahedra that have the node; NaN if one of them is NaN.
  double star_quality(int node) const;
  /// Tetrahedron beyond t's facet opposite to its corner i; -1: none, the facet is on the surface.
  int neighbour(int t, int i) const;
  /// The ring around a-b. False if the edge is on the surface or has more than max_ring.
  bool ring(int a, int b, EdgeRing& ring) const;

  int add(const Tet& t);
  void remove(int t);
  int add_node(const core::Vec3& x);
  /// Moves a node and computes its star's radius ratios again.
  void move(int node, const core::Vec3& x);

  /// What is left: nodes without tetrahedra dropped (not those of the surface), order kept.
  VolumeMesh mesh() const;

 private:
  std::size_t fixed_;
  std::vector<core::Vec3> nodes_;
  std::vector<Tet> tets_;  // first entry -1: taken away
  std::vector<double> quality_;
  std::vector<std::vector<int>> stars_;
};

/// even_permutations[i][j]: the two other corners k, l for which (i, j, k, l) is an even
/// permutation of (0, 1, 2, 3): a positive tetrahedron stays positive.
inline constexpr std::array<std::array<std::array<int, 2>, 4>, 4> even_permutations{
    {{{{-1, -1}, {2, 3}, {3, 1}, {1, 2}}},
     {{{3, 2}, {-1, -1}, {0, 3}, {2, 0}}},
     {{{1, 3}, {3, 0}, {-1, -1}, {0, 1}}},
     {{{2, 1}, {0, 2}, {1, 0}, {-1, -1}}}}};

/// Position of a node in a tetrahedron; -1: not in it.
inline int corner_of(const TetStore::Tet& t, int node) {
  for (int i = 0; i < 4; ++i)
    if (t[i] == node) return i;
  return -1;
}

}  // namespace polyslip::mesh
