#pragma once
// The linear solver of a Newton step: FGMRES on the saddle-point system of the mixed element,
//   [ A   B^T ] [du]   [ru]        A: tangent without the pressure's volume part
//   [ B   -C  ] [dp] = [rp]        B_e = D_e d V_e / d u,  C = diag(D_e^2 V_e / K)
// in its augmented form (B^T W times the second row added to the first: the same solution),
//   [ A + B^T W B   B^T (1 - W C) ] [du]   [ru + B^T W rp]
//   [ B             -C            ] [dp] = [rp           ]
// preconditioned from the right by an upper block triangle: p-multigrid (T10 -> vertices) in single
// precision for A + B^T W B and a diagonal for the pressure Schur complement. The operator is
// applied element by element in double precision; no matrix of the quadratic level is assembled.

#include <petscvec.h>

#include <memory>

#include "solver/linear_blocks.hpp"
#include "solver/multigrid.hpp"

namespace polyslip::solver {

struct LinearReport {
  int iterations = 0;
  bool converged = false;
  double right_side = 0;  ///< its norm
  double relative_residual = 0;
};

/// How the system is solved; the defaults are the ones to use, the others are there to be compared.
struct LinearSettings {
  Multigrid::Settings multigrid;
  /// Aggregates anew when a solve gains less than this share of the digits an iteration that the
  /// first one gained on the present aggregates.
  double renewal_rate = 0.75;
  /// The levels below the quadratic one are left as they are while the logarithm of its diagonal
  /// blocks' traces has changed by less than this (rms) since they were made.
  double kept_change = 0.1;
};

/// Collective. What has been set up is kept from one set of blocks to the next while it serves,
/// until convergence slows down or until `drop_setup`; after that the results are those of a new
/// solver, bit for bit.
class LinearSolver {
 public:
  explicit LinearSolver(LinearLayout layout, const LinearSettings& settings = {});
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// New blocks; renews the preconditioner. The blocks' arrays are not copied. Throws
  /// core::InternalError if one is missing.
  void set_blocks(const LinearBlocks& blocks);
  /// Solves to ||r|| <= tolerance ||b|| (2-norm of the whole residual and right side of the
  /// augmented form) from a zero guess; x: [du; dp]. ru: zero at Dirichlet dofs. rp, dp: null for
  /// the displacement element. Not converged: `converged` is false, du and dp hold the last iterate
  /// (NaN if the blocks hold one).
  LinearReport solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance, int max_iterations);
  /// The same from du and dp as a guess.
  LinearReport improve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance, int max_iterations);
  /// Forgets whatever a restart would not have, so that a run and its restart agree bit for bit.
  /// The blocks have to be set again.
  void drop_setup();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polyslip::solver
