#pragma once
// p-multigrid of a displacement block: quadratic level, vertex level.

#include <vector>

#include "solver/chebyshev.hpp"
#include "solver/coarse_solver.hpp"
#include "solver/vertex_level.hpp"

namespace polyslip::solver {

/// One V-cycle as an approximate inverse. Collective throughout.
class Multigrid {
 public:
  struct Settings {
    int sweeps_before = 0;
    int sweeps_after = 4;
    Chebyshev::Settings smoother;
    CoarseSolver::Settings coarse;
  };
  Multigrid(const LinearLayout& layout, const Settings& settings);

  /// Takes over the operator's tangents on the quadratic level.
  void set(const KrylovOperator& fine) { fine_.set(fine); }
  /// Renews the levels below and the smoother's interval, unless the quadratic level's diagonal has
  /// changed by less than `kept_change` (rms of the logarithm of its blocks' traces) since then.
  void renew_below(double kept_change);
  /// Lets the next `renew_below` aggregate anew instead of renewing numbers only.
  void renew_hierarchy() {
    coarse_.reset();
    scales_.clear();
  }
  /// x = V-cycle applied to b; both [owned_nodes][3]. May not be in place.
  void apply(const float* b, float* x);
  FineLevel& fine() { return fine_; }

 private:
  Settings settings_;
  FineLevel fine_;
  VertexLevel vertices_;
  Chebyshev smoother_;
  CoarseSolver coarse_;
  std::vector<float> x_, residual_, correction_;
  std::vector<double> coarse_rhs_, coarse_solution_;
  std::vector<float> scales_;  // [owned_nodes] of the diagonal when the levels below were made

  bool serves(const std::vector<float>& scales, double kept_change) const;
};

}  // namespace polyslip::solver
