#pragma once
// Chebyshev smoother on point blocks of three dofs, in single precision.

#include <vector>

#include "solver/fine_level.hpp"

namespace polyslip::solver {

/// Iteration x += q(D^-1 A) D^-1 (b - A x), D: the 3 x 3 diagonal blocks of A, q: the Chebyshev
/// polynomial of the interval [lower, 1] lambda_max (Saad, Iterative Methods for Sparse Linear
/// Systems, 2nd ed., algorithm 12.1). lambda_max is estimated from the tridiagonal matrix of some
/// conjugate-gradient steps from a fixed vector (same book, section 6.7.3), times a safety factor.
class Chebyshev {
 public:
  struct Settings {
    double safety = 1.3;  ///< on the estimated largest eigenvalue
    double lower = 0.1;   ///< end of the interval that is damped, relative to its upper end
    int steps = 10;       ///< of the estimate
  };
  Chebyshev(FineLevel& level, const Settings& settings);

  /// After the level has changed. Collective.
  void estimate();
  double largest_eigenvalue() const { return largest_; }
  /// `sweeps` products with A at most; with `zero_guess` x is overwritten. b: [owned_nodes][3];
  /// x: [local_nodes][3], whose ghosts are not kept up to date. Collective.
  void smooth(const float* b, float* x, int sweeps, bool zero_guess);

 private:
  FineLevel& level_;
  Settings settings_;
  double largest_ = 0;  // estimate times safety
  std::vector<float> residual_, product_, direction_;

  double dot(const std::vector<float>& a, const std::vector<float>& b) const;
};

}  // namespace polyslip::solver
