#include "solver/linear_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "support/solver/linear_problem.hpp"

namespace polyslip::solver {
namespace {

using test::LinearProblem;
using test::LinearProblemOptions;
using test::make_linear_problem;

LinearReport solve(LinearSolver& solver, const LinearProblem& p, double tolerance,
                   int max_iterations = 200) {
  return solver.solve(p.ru.get(), p.rp.get(), p.du.get(), p.dp.get(), tolerance, max_iterations);
}

int iterations(const LinearProblem& p, double tolerance) {
  LinearSolver solver(p.layout);
  solver.set_blocks(p.blocks());
  const LinearReport report = solve(solver, p, tolerance);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.relative_residual, tolerance);
  EXPECT_GT(report.iterations, 0);
  return report.iterations;
}

/// The whole vector on every rank.
std::vector<double> gather(Vec v) {
  ScatterHandle scatter;
  VecHandle all;
  check(VecScatterCreateToAll(v, scatter.out(), all.out()));
  check(VecScatterBegin(scatter.get(), v, all.get(), INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter.get(), v, all.get(), INSERT_VALUES, SCATTER_FORWARD));
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(VecGetSize(all.get(), &n));
  check(VecGetArrayRead(all.get(), &values));
  std::vector<double> result(values, values + n);
  check(VecRestoreArrayRead(all.get(), &values));
  return result;
}

std::vector<double> solution(const LinearProblem& p) {
  std::vector<double> x = gather(p.du.get());
  if (!p.B) return x;
  const std::vector<double> pressures = gather(p.dp.get());
  x.insert(x.end(), pressures.begin(), pressures.end());
  return x;
}

double relative_difference(const std::vector<double>& x, const std::vector<double>& y,
                           std::size_t first, std::size_t last) {
  double difference = 0, norm = 0;
  for (std::size_t i = first; i < last; ++i) {
    difference += (x[i] - y[i]) * (x[i] - y[i]);
    norm += y[i] * y[i];
  }
  return std::sqrt(difference / norm);
}

/// Larger of the relative differences of displacements and pressures.
double relative_difference(const std::vector<double>& x, const std::vector<double>& y,
                           const LinearProblem& p) {
  if (x.size() != y.size() || x.empty()) return std::numeric_limits<double>::infinity();
  PetscInt n = 0;
  check(VecGetSize(p.ru.get(), &n));
  const auto split = static_cast<std::size_t>(n);
  const double u = relative_difference(x, y, 0, split);
  return p.B ? std::max(u, relative_difference(x, y, split, x.size())) : u;
}

/// Solution by LU factorisation of the whole matrix [A B^T; B -C], on one rank.
std::vector<double> direct_solution(const LinearProblem& p) {
  MatHandle a, bt, c, nest, whole;
  check(MatConvert(p.A.get(), MATSEQAIJ, MAT_INITIAL_MATRIX, a.out()));
  if (p.B) {
    check(MatTranspose(p.B.get(), MAT_INITIAL_MATRIX, bt.out()));
    PetscInt n = 0;
    check(VecGetSize(p.C.get(), &n));
    check(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 1, nullptr, c.out()));
    check(MatSetUp(c.get()));
    const PetscScalar* values = nullptr;
    check(VecGetArrayRead(p.C.get(), &values));
    for (PetscInt i = 0; i < n; ++i) check(MatSetValue(c.get(), i, i, -values[i], INSERT_VALUES));
    check(VecRestoreArrayRead(p.C.get(), &values));
    check(MatAssemblyBegin(c.get(), MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(c.get(), MAT_FINAL_ASSEMBLY));
    std::array<Mat, 4> blocks{a.get(), bt.get(), p.B.get(), c.get()};
    check(MatCreateNest(PETSC_COMM_SELF, 2, nullptr, 2, nullptr, blocks.data(), nest.out()));
    check(MatConvert(nest.get(), MATSEQAIJ, MAT_INITIAL_MATRIX, whole.out()));
  } else {
    whole = std::move(a);
  }
  VecHandle b, x;
  check(MatCreateVecs(whole.get(), x.out(), b.out()));
  std::vector<double> rhs = gather(p.ru.get());
  if (p.B) {
    const std::vector<double> more = gather(p.rp.get());
    rhs.insert(rhs.end(), more.begin(), more.end());
  }
  check(VecPlaceArray(b.get(), rhs.data()));
  KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetType(ksp.get(), KSPPREONLY));
  check(KSPSetOperators(ksp.get(), whole.get(), whole.get()));
  check(KSPGetPC(ksp.get(), &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(KSPSolve(ksp.get(), b.get(), x.get()));
  check(VecResetArray(b.get()));
  return gather(x.get());
}

TEST(LinearSolver, IterationsAreFewAndDoNotGrowWithTheMesh) {
  LinearProblemOptions o;
  o.grains = 2;
  o.cells = 4;
  const LinearProblem small = make_linear_problem(PETSC_COMM_WORLD, o);
  o.cells = 8;
  const LinearProblem large = make_linear_problem(PETSC_COMM_WORLD, o);
  const std::array<double, 3> tolerances{1e-2, 1e-6, 1e-8};
  const std::array<int, 3> caps{8, 55, 90};
  for (int i = 0; i < 3; ++i) {
    const int coarse = iterations(small, tolerances[i]), fine = iterations(large, tolerances[i]);
    RecordProperty("iterations_" + std::to_string(i), fine);
    EXPECT_LE(coarse, caps[i]);
    EXPECT_LE(fine, caps[i]);
    EXPECT_LE(fine, 1.4 * coarse + 2);
  }
}

TEST(LinearSolver, AggregationBelowCostsFewIterationsMore) {
  LinearProblemOptions o;
  o.cells = 8;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearSettings settings;
  settings.multigrid.coarse.max_direct_dofs = 100;
  LinearSolver solver(p.layout, settings);
  solver.set_blocks(p.blocks());
  const LinearReport report = solve(solver, p, 1e-6);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 1.3 * iterations(p, 1e-6) + 2);
}

TEST(LinearSolver, AnyRatioOfBulkToShear) {
  for (const double ratio : {1.0, 10.0, 250.0, 1e4}) {
    LinearProblemOptions o;
    o.cells = 5;
    o.bulk_to_shear = ratio;
    const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
    EXPECT_LE(iterations(p, 1e-2), 9) << ratio;
    EXPECT_LE(iterations(p, 1e-8), 120) << ratio;
    EXPECT_LE(p.relative_residual(), 1e-5) << ratio;
  }
}

TEST(LinearSolver, GivesTheSolutionOfADirectSolve) {
  for (const bool mixed : {true, false}) {
    LinearProblemOptions o;
    o.cells = 3;
    o.mixed = mixed;
    if (!mixed) o.bulk_to_shear = 10;
    const std::vector<double> expected = direct_solution(make_linear_problem(PETSC_COMM_SELF, o));
    const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
    iterations(p, 1e-12);
    EXPECT_LE(relative_difference(solution(p), expected, p), 1e-8) << mixed;
    EXPECT_LE(p.relative_residual(), 1e-8) << mixed;
  }
}

TEST(LinearSolver, EveryFormHasTheSameSolution) {
  LinearProblemOptions o;
  o.cells = 3;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  iterations(p, 1e-12);
  const std::vector<double> expected = solution(p);
  for (const auto form :
       {LinearSettings::Form::original, LinearSettings::Form::original_transformed}) {
    LinearSettings settings;
    settings.form = form;
    LinearSolver solver(p.layout, settings);
    solver.set_blocks(p.blocks());
    EXPECT_TRUE(solve(solver, p, 1e-12, 400).converged);
    EXPECT_LE(relative_difference(solution(p), expected, p), 1e-7);
  }
}

TEST(LinearSolver, RanksMayHoldLittleOrNothing) {
  for (const auto& [cells, idle] : {std::pair{1, 0}, std::pair{3, 1}}) {
    LinearProblemOptions o;
    o.cells = cells;
    o.grains = 1;
    o.idle_ranks = idle;
    const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
    const LinearProblem alone = make_linear_problem(PETSC_COMM_SELF, o);
    iterations(p, 1e-12);
    iterations(alone, 1e-12);
    EXPECT_LE(relative_difference(solution(p), solution(alone), p), 1e-9);
  }
}

TEST(LinearSolver, AfterDropSetupItIsANewSolver) {
  LinearProblemOptions o;
  o.cells = 5;
  const LinearProblem first = make_linear_problem(PETSC_COMM_WORLD, o);
  o.seed = 2;
  o.softest = 500;
  const LinearProblem second = make_linear_problem(PETSC_COMM_WORLD, o);
  for (const PetscInt max_direct : {100000, 100}) {
    LinearSettings settings;
    settings.multigrid.coarse.max_direct_dofs = max_direct;
    LinearSolver used(first.layout, settings);
    used.set_blocks(first.blocks());
    solve(used, first, 1e-3);
    used.set_blocks(second.blocks());
    EXPECT_TRUE(solve(used, second, 1e-3).converged);
    used.drop_setup();
    EXPECT_THROW(solve(used, second, 1e-3), core::InternalError);
    used.set_blocks(second.blocks());
    const LinearReport again = solve(used, second, 1e-3);
    const std::vector<double> after = solution(second);

    LinearSolver fresh(second.layout, settings);
    fresh.set_blocks(second.blocks());
    const LinearReport once = solve(fresh, second, 1e-3);
    EXPECT_TRUE(once.converged);
    EXPECT_EQ(again.iterations, once.iterations);
    EXPECT_EQ(again.relative_residual, once.relative_residual);
    EXPECT_EQ(after, solution(second));
  }
}

TEST(LinearSolver, SaysWhenItDidNotConverge) {
  LinearProblemOptions o;
  o.cells = 3;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearSolver solver(p.layout);
  solver.set_blocks(p.blocks());
  const LinearReport report = solve(solver, p, 1e-8, 3);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_GT(report.relative_residual, 1e-8);

  check(VecSet(p.ru.get(), 0));
  check(VecSet(p.rp.get(), 0));
  check(VecSet(p.du.get(), 7));
  EXPECT_TRUE(solve(solver, p, 1e-8).converged);
  PetscReal norm = 1;
  check(VecNorm(p.du.get(), NORM_2, &norm));
  EXPECT_EQ(norm, 0);
}

TEST(LinearSolver, ANaNIsNotASolution) {
  LinearProblemOptions o;
  o.cells = 2;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearSolver solver(p.layout);
  check(VecScale(p.schur.get(), std::nan("")));
  solver.set_blocks(p.blocks());
  EXPECT_FALSE(solve(solver, p, 1e-3).converged);
  const LinearProblem q = make_linear_problem(PETSC_COMM_WORLD, o);
  solver.set_blocks(q.blocks());
  EXPECT_TRUE(solve(solver, q, 1e-3).converged);
  check(VecScale(q.ru.get(), std::nan("")));
  EXPECT_FALSE(solve(solver, q, 1e-3).converged);
}

TEST(LinearSolver, RefusesBlocksThatDoNotFit) {
  LinearProblemOptions o;
  o.cells = 2;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearSolver solver(p.layout);
  EXPECT_THROW(solve(solver, p, 1e-3), core::InternalError);
  LinearBlocks blocks = p.blocks();
  blocks.W = nullptr;
  EXPECT_THROW(solver.set_blocks(blocks), core::InternalError);
  o.cells = 3;
  const LinearProblem other = make_linear_problem(PETSC_COMM_WORLD, o);
  EXPECT_THROW(solver.set_blocks(other.blocks()), core::InternalError);
  LinearLayout layout = p.layout;
  layout.constrained.clear();
  EXPECT_THROW(VertexLevel{layout}, core::InternalError);
}

TEST(VertexLevel, ProlongsLinearFieldsAndGivesTheGalerkinProduct) {
  LinearProblemOptions o;
  o.cells = 3;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearLayout free = p.layout;
  std::fill(free.constrained.begin(), free.constrained.end(), 0);
  const VertexLevel unconstrained(free);
  ASSERT_EQ(unconstrained.nodes(), 64);
  const auto field = [](const double* x, int a) {
    return 1 + a + (2 + a) * x[0] - x[1] + 3 * x[2];
  };
  std::vector<double> coarse(3 * 64), fine(3 * free.local_nodes, 0.0);
  for (int i = 0; i < 64; ++i) {
    for (int a = 0; a < 3; ++a) coarse[3 * i + a] = field(&unconstrained.coordinates()[3 * i], a);
  }
  unconstrained.prolong_add(coarse.data(), fine.data());
  for (PetscInt i = 0; i < free.local_nodes; ++i) {
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(fine[3 * i + a], field(&free.coordinates[3 * i], a), 1e-14);
    }
  }

  // P^T A P x = P^T (A (P x)) for a vector x that is zero at constrained dofs.
  VertexLevel level(p.layout);
  VecHandle px, apx;
  check(VecDuplicate(p.ru.get(), px.out()));
  check(VecDuplicate(p.ru.get(), apx.out()));
  check(VecZeroEntries(px.get()));
  PetscScalar* values = nullptr;
  check(VecGetArray(px.get(), &values));
  level.prolong_add(coarse.data(), values);
  check(VecRestoreArray(px.get(), &values));
  check(MatMult(p.A.get(), px.get(), apx.get()));
  std::vector<double> expected(3 * 64), x = coarse, y(3 * 64);
  const PetscScalar* product = nullptr;
  check(VecGetArrayRead(apx.get(), &product));
  level.restrict_to(product, expected.data());
  check(VecRestoreArrayRead(apx.get(), &product));
  const Mat galerkin = level.galerkin(p.A.get());
  VecHandle vx, vy;
  check(MatCreateVecs(galerkin, vx.out(), vy.out()));
  check(VecPlaceArray(vx.get(), x.data()));
  check(VecPlaceArray(vy.get(), y.data()));
  check(MatMult(galerkin, vx.get(), vy.get()));
  double norm = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double* at = &level.coordinates()[3 * (i / 3)];
    const int a = static_cast<int>(i % 3);
    const bool fixed = at[a] < 1e-9 || (a > 0 && at[a] > 1 - 1e-9);
    EXPECT_NEAR(y[i], fixed ? coarse[i] : expected[i], 1e-7) << i;
    norm += expected[i] * expected[i];
  }
  EXPECT_GT(norm, 1);
}

}  // namespace
}  // namespace polyslip::solver
