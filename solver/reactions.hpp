#pragma once
// Forces on the faces of the domain, and how far the free nodes are from balance.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/boundary.hpp"
#include "solver/partition.hpp"

namespace polyslip::solver {

/// [face x0 ... z1][component] force of the surroundings on the body [MPa length^2]
using FaceForces = std::array<std::array<double, 3>, 6>;

/// Sums of the nodal forces on each face. A component of a node that is prescribed counts for the
/// faces that prescribe it; a free one for every face the node is on (its residual).
/// forces: [local_nodes][3]. Collective.
FaceForces face_forces(const LocalMesh& local, const Boundary& boundary,
                       const std::vector<double>& forces);

/// Imbalance of a configuration.
struct Balance {
  double free_norm = 0;                     ///< 2-norm of the forces on free dofs
  double reaction_norm = 0;                 ///< 2-norm of the forces on prescribed dofs
  double free_dofs = 0, reaction_dofs = 0;  ///< how many of either there are
  std::array<double, 3> resultant{};        ///< sum of the forces on free dofs
  std::array<double, 3> moment{};           ///< sum of x_i f_i of free dofs: volume times the error
                                            ///< that they make in the mean stress
  double largest_face_force = 0;
  double volume_gap = 0;  ///< volume-weighted rms of ln(V/V0) - p/K
};

/// forces: residuals (internal minus external); x: positions. Collective.
Balance balance(const LocalMesh& local, const Boundary& boundary,
                const std::vector<std::uint8_t>& constrained, const std::vector<double>& forces,
                const std::vector<double>& x, const std::vector<double>& volumes,
                const std::vector<double>& volume_gap);

/// [local_nodes][3] prescribed dofs
std::vector<std::uint8_t> constrained_dofs(const LocalMesh& local, const Boundary& boundary);

}  // namespace polyslip::solver
