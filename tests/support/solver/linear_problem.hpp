#pragma once
// Saddle-point systems to try linear solvers on: a cube of quadratic tetrahedra with a polycrystal
// of cube-shaped grains, whose tangents look like those of a crystal under flow.

#include <cstdint>

#include "solver/linear_blocks.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::test {

struct LinearProblemOptions {
  int cells = 4;   ///< per side; six tetrahedra a cell
  int grains = 2;  ///< per side
  double bulk_to_shear =
      250;              ///< K / mean mu_e, mu_e: half the geometric mean of a tangent's eigenvalues
  double softest = 70;  ///< about the smallest eigenvalue of a tangent, MPa
  double stiffest = 50e3;  ///< its largest one, MPa
  double skew = 0.02;      ///< unsymmetric part of a tangent relative to its symmetric part
  double weight = 4;       ///< augmentation W = min(weight mu_e, K) / V_e
  bool mixed = true;       ///< else the displacement element, K inside A
  int idle_ranks = 0;      ///< ranks, the last ones, that own nothing (one rank is left)
  std::uint64_t seed = 1;
};

/// System of one increment of plane-strain compression: z faces displaced, y faces and x0 fixed in
/// their normal direction, x1 free. Nodes are numbered along the lattice of half cells, so that
/// the numbering does not depend on the number of ranks.
struct LinearProblem {
  solver::LinearLayout layout;
  solver::MatHandle A, A_augmented, B;
  solver::VecHandle C, W, schur, ru, rp, du, dp;

  solver::LinearBlocks blocks() const {
    return {A.get(), A_augmented.get(), B.get(), C.get(), W.get(), schur.get()};
  }
  /// ||b - M x|| / ||b|| of the system as it stands (not augmented), u and p rows apart, larger.
  double relative_residual() const;
};

/// Collective over `comm`; the same system for any number of ranks, but for rounding.
LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& options);

}  // namespace polyslip::test
