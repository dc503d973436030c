// Compares variants of the linear solver on cubes of quadratic tetrahedra (docs/benchmarks.md):
// iterations to four tolerances, CPU seconds of the first set-up, of its renewal and of solves.
//   linear_solver [cells per side, 12] [grains per side, 4]
#include <fmt/core.h>

#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "solver/linear_solver.hpp"
#include "solver/petsc_session.hpp"
#include "support/solver/linear_problem.hpp"

namespace {

using polyslip::solver::LinearSettings;
using polyslip::solver::LinearSolver;
using polyslip::test::LinearProblem;
using polyslip::test::LinearProblemOptions;

double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// One row of the table.
void run(const std::string& name, const LinearProblem& p,
         const std::function<void(LinearSettings&)>& change) {
  int rank = 0;
  MPI_Comm_rank(p.mesh->local().comm, &rank);
  LinearSettings settings;
  change(settings);
  const double start = cpu();
  LinearSolver solver(p.layout, settings);
  solver.set_blocks(p.blocks());
  const double set_up = cpu() - start;
  solver.set_blocks(p.blocks());
  std::string text = fmt::format("| {} | {:.2f} | {:.2f} |", name, set_up, cpu() - start - set_up);
  std::string times;
  for (const double tolerance : {1e-2, 1e-3, 1e-6, 1e-8}) {
    const double before = cpu();
    const auto report =
        solver.solve(p.ru.get(), p.rp.get(), p.du.get(), p.dp.get(), tolerance, 400);
    text += fmt::format(" {}{}", report.iterations, report.converged ? "" : "+");
    text += tolerance == 1e-8 ? " |" : " /";
    if (tolerance == 1e-2) times += fmt::format(" {:.2f} |", cpu() - before);
    if (tolerance == 1e-6) times += fmt::format(" {:.2f} |", cpu() - before);
  }
  if (rank == 0) fmt::print("{}{}\n", text, times);
}

void compare_variants(const LinearProblemOptions& o) {
  const LinearProblem p = polyslip::test::make_linear_problem(MPI_COMM_WORLD, o);
  const auto sweeps = [](int before, int after) {
    return [=](LinearSettings& s) {
      s.multigrid.sweeps_before = before;
      s.multigrid.sweeps_after = after;
    };
  };
  run("**default**", p, [](LinearSettings&) {});
  for (const auto& [before, after] : {std::pair{1, 1}, {2, 2}, {3, 3}, {0, 2}, {0, 6}, {0, 8}}) {
    run(fmt::format("sweeps {} before, {} after", before, after), p, sweeps(before, after));
  }
  for (const int n : {1, 2, 8}) {
    run(fmt::format("{} iteration(s) on the vertex level", n), p,
        [&](LinearSettings& s) { s.multigrid.coarse.iterations = n; });
  }
  run("direct neighbours aggregated only", p, [](LinearSettings& s) {
    s.multigrid.coarse.aggressive_levels = 0;
    s.multigrid.coarse.iterations = 1;
  });
  run("unsmoothed aggregation", p,
      [](LinearSettings& s) { s.multigrid.coarse.prolongation_smoothings = 0; });
  run("LU on the vertex level", p,
      [](LinearSettings& s) { s.multigrid.coarse.max_direct_dofs = 1000000; });
}

}  // namespace

int main(int argc, char** argv) {
  const polyslip::solver::PetscSession session;
  LinearProblemOptions o;
  o.cells = argc > 1 ? std::atoi(argv[1]) : 12;
  o.grains = argc > 2 ? std::atoi(argv[2]) : 4;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    fmt::print("{} elements\n", 6 * o.cells * o.cells * o.cells);
    fmt::print("| variant | set-up s | renewal s | iterations to 1e-2 / 1e-3 / 1e-6 / 1e-8 | ");
    fmt::print("solve to 1e-2 s | to 1e-6 s |\n|---|---|---|---|---|---|\n");
  }
  if (o.cells > 12) {  // too long for every variant
    run("**default**", polyslip::test::make_linear_problem(MPI_COMM_WORLD, o),
        [](LinearSettings&) {});
    return 0;
  }
  compare_variants(o);
  for (const double weight : {1.0, 2.0, 8.0, 16.0}) {
    LinearProblemOptions other = o;
    other.weight = weight;
    run(fmt::format("augmentation weight {}", weight),
        polyslip::test::make_linear_problem(MPI_COMM_WORLD, other), [](LinearSettings&) {});
  }
  for (const double ratio : {10.0, 1e4}) {
    LinearProblemOptions other = o;
    other.bulk_to_shear = ratio;
    run(fmt::format("K / mu {}", ratio), polyslip::test::make_linear_problem(MPI_COMM_WORLD, other),
        [](LinearSettings&) {});
  }
  LinearProblemOptions other = o;
  other.mixed = false;
  other.bulk_to_shear = 10;
  run("displacement element, K / mu 10", polyslip::test::make_linear_problem(MPI_COMM_WORLD, other),
      [](LinearSettings&) {});
  return 0;
}
