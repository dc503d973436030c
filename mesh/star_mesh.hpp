#pragma once
// Tetrahedra of all grains as flat arrays, with the tetrahedra around each node of the grains'
// surfaces: what it takes to move those nodes without changing which tetrahedra there are.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

class StarMesh {
 public:
  using Tet = std::array<int, 4>;

  /// Nodes [0, surface_count) are those of the surfaces.
  StarMesh(std::vector<core::Vec3> nodes, std::vector<Tet> tets, int surface_count);

  const core::Vec3& position(int node) const { return nodes_[node]; }
  void move(int node, const core::Vec3& x) { nodes_[node] = x; }
  const Tet& tet(int t) const { return tets_[t]; }
  /// Tetrahedra, of every grain, that have this surface node.
  std::span<const int> star(int node) const {
    return {stars_.data() + first_[node],
            static_cast<std::size_t>(first_[node + 1] - first_[node])};
  }

 private:
  std::vector<core::Vec3> nodes_;
  std::vector<Tet> tets_;
  std::vector<std::int64_t> first_;  ///< [surface_count + 1]
  std::vector<int> stars_;
};

/// (P.29), the sum over a node's star of rho^-power (a multiple of three), with its gradient by the
/// node's position.
struct StarDescent {
  double sum = 0, least = 0;  ///< least: least radius ratio
  double reach = 0;           ///< least distance to another node of the star
  core::Vec3 gradient = core::Vec3::Zero();
};
StarDescent star_descent(const StarMesh& mesh, int node, int power = 3);

/// Whether the star with the node at x has a lesser sum and no element below the least one now.
bool star_improves(const StarMesh& mesh, int node, const core::Vec3& x, const StarDescent& now,
                   int power = 3);

}  // namespace polyslip::mesh
