#pragma once
// The linear solver of a Newton step: FGMRES on the saddle-point system of the mixed element,
//   [ A   B^T ] [du]   [ru]        A: tangent without the pressure's volume part
//   [ B   -C  ] [dp] = [rp]        B_e = d V_e / d u,  C = diag(V_e / K)
// preconditioned by an upper block triangle: p-multigrid (T10 -> vertices) on the augmented
// A + weight sum_e (mu_e / V_e) b_e b_e^T, and a diagonal for the pressure Schur complement.

#include <mpi.h>
#include <petscksp.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace polyslip::solver {

/// Rows of this rank; PETSc's global numbering (3 dofs a node, nodes owned contiguously).
struct LinearLayout {
  MPI_Comm comm = MPI_COMM_SELF;
  PetscInt local_nodes = 0;          ///< nodes this rank owns
  PetscInt local_pressures = 0;      ///< elements this rank owns (0 for the displacement element)
  /// For each owned node, the global nodes whose mean it is on the vertex level: itself twice for
  /// a corner, the two ends of its edge for a mid node.
  std::vector<std::array<PetscInt, 2>> parents;
  std::vector<std::uint8_t> is_corner;     ///< [local_nodes]
  std::vector<double> coordinates;         ///< [local_nodes][3], for the rigid-body modes
  std::vector<std::uint8_t> constrained;   ///< [local_nodes][3] Dirichlet dofs
};

/// The blocks, assembled. Dirichlet rows and columns of A, A_augmented and columns of B are
/// already eliminated (unit diagonal in A, zero columns in B).
struct LinearBlocks {
  Mat A = nullptr;            ///< BAIJ/AIJ, block size 3
  Mat A_augmented = nullptr;  ///< A + weight * sum (mu_e/V_e) b b^T; = A for the displacement element
  Mat B = nullptr;            ///< [pressures][3 nodes]; null for the displacement element
  Vec C = nullptr;            ///< [pressures] V_e / K; null likewise
  Vec schur = nullptr;        ///< [pressures] V_e (1/((1 + weight) mu_e) + 1/K), positive
};

struct LinearReport {
  int iterations = 0;
  bool converged = false;
  double relative_residual = 0;
};

/// Collective. Set-ups (multigrid hierarchy) are kept between solves until `drop_setup`, and
/// rebuilt when `refresh` says that the blocks changed enough.
class LinearSolver {
 public:
  explicit LinearSolver(LinearLayout layout);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// New matrices; rebuilds the preconditioner.
  void set_blocks(const LinearBlocks& blocks);
  /// Solves to ||r|| <= tolerance ||b|| (2-norm of the whole right side); x: [du; dp].
  LinearReport solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance, int max_iterations);
  /// Forgets whatever a restart would not have, so that a run and its restart agree bit for bit.
  void drop_setup();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polyslip::solver
