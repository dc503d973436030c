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
  Multigrid(const LinearLayout& layout, const Settings& settings)
      : settings_(settings),
        vertices_(layout),
        smoother_(settings.smoother),
        coarse_(settings.coarse) {}

  /// A: BAIJ of block size 3; the structure is that of the first call.
  void set_matrix(Mat A);
  /// Lets the next `set_matrix` aggregate anew instead of renewing numbers only.
  void renew_hierarchy() { coarse_.reset(); }
  /// x = V-cycle applied to b.
  void apply(Vec b, Vec x);

 private:
  Settings settings_;
  VertexLevel vertices_;
  Chebyshev smoother_;
  CoarseSolver coarse_;
  MatHandle matrix_;
  VecHandle residual_;
  std::vector<double> coarse_rhs_, coarse_solution_;
};

}  // namespace polyslip::solver
