// Compares variants of the linear solver on cubes of quadratic tetrahedra (docs/benchmarks.md):
// iterations to three tolerances, CPU seconds of the set-up and of the solve to 1e-6.
#include <fmt/core.h>

#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "solver/linear_solver.hpp"
#include "solver/petsc_session.hpp"
#include "support/solver/linear_problem.hpp"

namespace {

using polyslip::solver::LinearSettings;
using polyslip::solver::LinearSolver;

double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void run(const std::string& name, const LinearSettings& settings,
         const polyslip::test::LinearProblem& p) {
  int rank = 0;
  MPI_Comm_rank(p.layout.comm, &rank);
  const double start = cpu();
  LinearSolver solver(p.layout, settings);
  solver.set_blocks(p.blocks());
  const double set_up = cpu() - start;
  solver.set_blocks(p.blocks());
  const double renewed = cpu() - start - set_up;
  std::string text;
  for (const double tolerance : {1e-2, 1e-3, 1e-6, 1e-8}) {
    const double before = cpu();
    const auto report =
        solver.solve(p.ru.get(), p.rp.get(), p.du.get(), p.dp.get(), tolerance, 200);
    text += fmt::format("{:4d}", report.iterations);
    if (tolerance == 1e-6) {
      text += fmt::format(" ({:.2f} s, {:.0e})", cpu() - before, p.relative_residual());
    }
  }
  if (rank == 0)
    fmt::print("{:44s} set-up {:.2f} renew {:.2f}  its {}\n", name, set_up, renewed, text);
}

}  // namespace

int main(int argc, char** argv) {
  const polyslip::solver::PetscSession session;
  polyslip::test::LinearProblemOptions o;
  o.cells = argc > 1 ? std::atoi(argv[1]) : 6;
  o.grains = argc > 2 ? std::atoi(argv[2]) : 3;
  const auto p = polyslip::test::make_linear_problem(MPI_COMM_WORLD, o);
  using Form = LinearSettings::Form;
  for (const auto& [form, name] :
       {std::pair{Form::augmented, "augmented"}, std::pair{Form::original, "original"},
        std::pair{Form::original_transformed, "transformed"}}) {
    for (const int limit : {3000, 100000}) {
      for (const int sweeps : {1, 2, 3, 4}) {
        LinearSettings s;
        s.form = form;
        s.multigrid.sweeps_before = s.multigrid.sweeps_after = sweeps;
        s.multigrid.coarse.max_direct_dofs = limit;
        run(fmt::format("{} {}+{} direct<{}", name, sweeps, sweeps, limit), s, p);
      }
      LinearSettings s;
      s.form = form;
      s.multigrid.coarse.max_direct_dofs = limit;
      s.multigrid.sweeps_before = 0;
      for (const int sweeps : {4, 6, 8}) {
        s.multigrid.sweeps_after = sweeps;
        run(fmt::format("{} 0+{} direct<{}", name, sweeps, limit), s, p);
      }
    }
  }
  return 0;
}
