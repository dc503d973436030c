#pragma once
// What the linear solver is given: layout of the unknowns and blocks of the saddle-point system.

#include <mpi.h>
#include <petscksp.h>

#include <array>
#include <cstdint>
#include <vector>

namespace polyslip::solver {

/// Rows of this rank; PETSc's global numbering (3 dofs a node, nodes owned contiguously).
struct LinearLayout {
  MPI_Comm comm = MPI_COMM_SELF;
  PetscInt local_nodes = 0;      ///< nodes this rank owns
  PetscInt local_pressures = 0;  ///< elements this rank owns (0 for the displacement element)
  /// For each owned node, the global nodes whose mean it is on the vertex level: itself twice for
  /// a corner, the two ends of its edge for a mid node.
  std::vector<std::array<PetscInt, 2>> parents;
  std::vector<std::uint8_t> is_corner;    ///< [local_nodes]
  std::vector<double> coordinates;        ///< [local_nodes][3], for the rigid-body modes
  std::vector<std::uint8_t> constrained;  ///< [local_nodes][3] Dirichlet dofs
};

/// The blocks, assembled. Dirichlet rows and columns of A and A_augmented and columns of B are
/// already eliminated (unit diagonal in A, zero columns in B). The augmentation W is one positive
/// number an element; min(4 mu_e, K) / V_e is a good one (W = 1/C condenses the pressure exactly),
/// mu_e being half the geometric mean of the five eigenvalues of the deviatoric tangent: det^(1/5)
/// / 2, meaned over the points (with the harmonic mean iterations double). Whoever wants a volume
/// residual to count in the solver's 2-norm scales the rows of B (and B^T, C, W, schur with them)
/// to units of force.
struct LinearBlocks {
  Mat A = nullptr;            ///< BAIJ/AIJ, block size 3; not used in the augmented form
  Mat A_augmented = nullptr;  ///< A + B^T W B; = A for the displacement element
  Mat B = nullptr;            ///< [pressures][3 nodes]; null for the displacement element
  Vec C = nullptr;            ///< [pressures] V_e / K; null likewise
  Vec W = nullptr;            ///< [pressures] the augmentation; null likewise
  /// [pressures] C + (1 - W C) / (mu_e / V_e + W): diagonal Schur complement of the augmented
  /// system, positive; with W = w mu_e / V_e and K >> mu_e it is V_e (1/((1 + w) mu_e) + 1/K).
  Vec schur = nullptr;
};

}  // namespace polyslip::solver
