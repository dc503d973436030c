#pragma once
// Solver of the vertex level.

#include <vector>

#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

/// Approximate inverse of the vertex level's matrix: an LU factorisation of a small one (on every
/// rank), else a few
/// GMRES iterations with a cycle of smoothed aggregation (PETSc's GAMG, rigid-body modes).
/// Collective throughout.
class CoarseSolver {
 public:
  struct Settings {
    PetscInt max_direct_dofs = 1000;  ///< LU up to this size
    int iterations = 2;               ///< of GMRES; with 1 a single cycle is taken
    int prolongation_smoothings = 1;  ///< of the aggregates' rigid-body modes
    int aggressive_levels = 10;       ///< finest levels that aggregate neighbours of neighbours
    double threshold = 0.01;          ///< relative size of the couplings dropped when aggregating
  };
  CoarseSolver() = default;
  explicit CoarseSolver(const Settings& settings) : settings_(settings) {}

  /// Sets up, or renews the numbers of an earlier set-up of the same matrix (its structure kept).
  /// coordinates: [owned nodes][3].
  void set_matrix(Mat A, const std::vector<double>& coordinates);
  /// x = approximate inverse times b; both [owned dofs].
  void solve(const double* b, double* x);
  void reset() { *this = CoarseSolver(settings_); }

 private:
  void create(Mat A, const std::vector<double>& coordinates);

  Settings settings_;
  MatHandle matrix_;
  KspHandle ksp_;
  VecHandle rhs_, solution_;
};

}  // namespace polyslip::solver
