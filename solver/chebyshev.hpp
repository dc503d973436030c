#pragma once
// Chebyshev smoother on point blocks of three dofs.

#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

/// Iteration x += q(D^-1 A) D^-1 (b - A x), D: the 3 x 3 diagonal blocks of A, q: the Chebyshev
/// polynomial of the interval [lower, 1] lambda_max (Saad, Iterative Methods for Sparse Linear
/// Systems, 2nd ed., algorithm 12.1). lambda_max is estimated by ten Arnoldi steps from a fixed
/// vector, times a safety factor. Meant for A that is nearly symmetric.
class Chebyshev {
 public:
  struct Settings {
    double safety = 1.3;  ///< on the estimated largest eigenvalue
    double lower = 0.1;   ///< end of the interval that is damped, relative to its upper end
    int arnoldi_steps = 10;
  };
  Chebyshev() = default;
  explicit Chebyshev(const Settings& settings) : settings_(settings) {}

  /// Keeps a reference to A (block size 3). Collective.
  void set_matrix(Mat A);
  double largest_eigenvalue() const { return largest_; }
  /// `sweeps` products with A at most; with `zero_guess` x is overwritten. Collective.
  void smooth(Vec b, Vec x, int sweeps, bool zero_guess);
  void reset() { *this = Chebyshev(settings_); }

 private:
  double estimate_largest_eigenvalue();

  Settings settings_;
  double largest_ = 0;  // estimate times safety
  MatHandle matrix_;
  PcHandle jacobi_;
  VecHandle residual_, scaled_, direction_;
};

}  // namespace polyslip::solver
