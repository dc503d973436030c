#include "solver/linear_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseLU>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "mesh/quadrature.hpp"
#include "solver/exchange.hpp"
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
  const auto split = 3 * static_cast<std::size_t>(p.mesh->local().global_nodes);
  const double u = relative_difference(x, y, 0, split);
  return p.layout.mixed ? std::max(u, relative_difference(x, y, split, x.size())) : u;
}

/// Solution by LU factorisation of the whole matrix [A B^T; B -C], on one rank.
std::vector<double> direct_solution(const LinearProblem& p) {
  const LocalMesh& mesh = p.mesh->local();
  const auto nodes = static_cast<Eigen::Index>(3 * mesh.owned_nodes);
  const auto size = nodes + static_cast<Eigen::Index>(p.layout.pressures());
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < mesh.element_count(); ++e) {
    ElementMatrix matrix;
    ElementForces b;
    p.element(e, matrix, b);
    const auto dof = [&](int k) { return 3 * mesh.elements[e][k / 3] + k % 3; };
    for (int r = 0; r < 30; ++r) {
      if (p.layout.constrained[dof(r)]) continue;
      for (int c = 0; c < 30; ++c)
        if (!p.layout.constrained[dof(c)])
          entries.emplace_back(dof(r), dof(c), matrix[r / 3][r % 3][c / 3][c % 3]);
      if (!p.layout.mixed) continue;
      const double coupling = p.scale[e] * b[r / 3][r % 3];
      entries.emplace_back(dof(r), nodes + e, coupling);
      entries.emplace_back(nodes + e, dof(r), coupling);
    }
    if (p.layout.mixed) entries.emplace_back(nodes + e, nodes + e, -p.C[e]);
  }
  for (int i = 0; i < nodes; ++i)
    if (p.layout.constrained[i]) entries.emplace_back(i, i, 1);
  Eigen::SparseMatrix<double> whole(size, size);
  whole.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd rhs(size);
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(p.ru.get(), &values));
  std::copy_n(values, nodes, rhs.data());
  check(VecRestoreArrayRead(p.ru.get(), &values));
  check(VecGetArrayRead(p.rp.get(), &values));
  std::copy_n(values, size - nodes, rhs.data() + nodes);
  check(VecRestoreArrayRead(p.rp.get(), &values));
  const Eigen::VectorXd x = Eigen::SparseLU<Eigen::SparseMatrix<double>>(whole).solve(rhs);
  // Local nodes are those of the mesh: one rank.
  return {x.data(), x.data() + x.size()};
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
    EXPECT_LE(relative_difference(p.solution(), expected, p), 1e-8) << mixed;
    EXPECT_LE(p.relative_residual(), 1e-8) << mixed;
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
    EXPECT_LE(relative_difference(p.solution(), alone.solution(), p), 1e-9);
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
    const std::vector<double> after = second.solution();

    LinearSolver fresh(second.layout, settings);
    fresh.set_blocks(second.blocks());
    const LinearReport once = solve(fresh, second, 1e-3);
    EXPECT_TRUE(once.converged);
    EXPECT_EQ(again.iterations, once.iterations);
    EXPECT_EQ(again.relative_residual, once.relative_residual);
    EXPECT_EQ(after, second.solution());
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
  LinearBlocks broken = p.blocks();
  const std::vector<double> nans(p.schur.size(), std::nan(""));
  broken.schur = nans.data();
  solver.set_blocks(broken);
  EXPECT_FALSE(solve(solver, p, 1e-3).converged);
  const std::vector<double> tangents(p.tangent.size(), std::nan(""));
  broken = p.blocks();
  broken.tangent = tangents.data();
  solver.set_blocks(broken);
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
  LinearLayout layout = p.layout;
  layout.constrained.clear();
  EXPECT_THROW(VertexLevel{layout}, core::InternalError);
}

/// Numbers between -1 and 1 that depend on the mesh's node or element alone; zero where fixed.
std::vector<double> some_numbers(const std::vector<int>& mesh_number, int components) {
  std::vector<double> out;
  for (int n : mesh_number)
    for (int c = 0; c < components; ++c) out.push_back(std::sin(1.0 + 12.9898 * n + 78.233 * c));
  return out;
}

/// Small problems of both elements with each quadrature rule.
std::vector<LinearProblemOptions> every_element() {
  std::vector<LinearProblemOptions> all;
  for (const int points : mesh::tet_quadrature_sizes)
    for (const bool mixed : {true, false}) {
      LinearProblemOptions o;
      o.cells = points == 4 ? 3 : 2;
      o.mixed = mixed;
      o.points = points;
      all.push_back(o);
      o.straight = true;
      if (!mixed && points == 15) all.push_back(o);
    }
  return all;
}

TEST(KrylovOperator, IsThatOfTheElementsMatrices) {
  for (LinearProblemOptions o : every_element()) {
    SCOPED_TRACE(o.points);
    o.bulk_to_shear = 50;
    o.resistance = 2;
    o.stress = 300;
    const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
    KrylovOperator fine(p.layout);
    fine.set(p.blocks());
    std::vector<double> u = some_numbers(p.mesh->local().node_mesh, 3);
    const std::vector<double> pressure = some_numbers(p.mesh->local().element_mesh, 1);
    for (std::size_t i = 0; i < u.size(); ++i)
      if (p.layout.constrained[i]) u[i] = 0;
    std::vector<double> yu, yp, fu(p.layout.displacements()), fp(yp);
    p.apply_plain(u, pressure, yu, yp);
    fp.resize(yp.size());
    fine.apply(u.data(), pressure.data(), fu.data(), fp.data());
    double scale = 0;
    for (double y : yu) scale = std::max(scale, std::abs(y));
    EXPECT_GT(scale, 1);
    if (o.mixed) {  // the augmentation: B^T W times the second row
      std::vector<double> w(yp.size());
      for (std::size_t e = 0; e < w.size(); ++e) {
        EXPECT_NEAR(fp[e], yp[e], 1e-9 * scale) << e;
        w[e] = p.W[e] * yp[e];
      }
      fine.add_volume_forces(w.data(), yu.data());
    }
    for (std::size_t i = 0; i < fu.size(); ++i) EXPECT_NEAR(fu[i], yu[i], 1e-9 * scale) << i;
  }
}

TEST(FineLevel, IsTheSymmetricPartInSinglePrecision) {
  for (LinearProblemOptions o : every_element()) {
    SCOPED_TRACE(o.points);
    o.bulk_to_shear = 20;
    o.skew = 0;
    o.stress = 0;
    const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
    KrylovOperator fine(p.layout);
    fine.set(p.blocks());
    FineLevel level(p.layout);
    level.set(fine);
    std::vector<double> u = some_numbers(p.mesh->local().node_mesh, 3);
    std::vector<float> x(u.size()), y(level.dofs());
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (p.layout.constrained[i]) u[i] = 0;
      x[i] = static_cast<float>(u[i]);
    }
    std::vector<double> none(p.mesh->local().elements.size(), 0), fu(level.dofs()), fp(none);
    fine.apply(u.data(), none.data(), fu.data(), fp.data());
    level.apply(x.data(), y.data());
    double scale = 0;
    for (double f : fu) scale = std::max(scale, std::abs(f));
    EXPECT_GT(maximum(PETSC_COMM_WORLD, scale), 1);
    scale = maximum(PETSC_COMM_WORLD, scale);
    for (std::size_t i = 0; i < fu.size(); ++i) EXPECT_NEAR(y[i], fu[i], 1e-5 * scale) << i;
  }
}

TEST(FineLevel, InverseDiagonalIsThatOfTheOperator) {
  LinearProblemOptions o;
  o.cells = 2;
  o.resistance = 1;
  const LinearProblem p = make_linear_problem(PETSC_COMM_SELF, o);
  KrylovOperator fine(p.layout);
  fine.set(p.blocks());
  FineLevel level(p.layout);
  level.set(fine);
  std::vector<float> x(level.local_dofs(), 0.0f), y(level.dofs()), z(level.dofs());
  for (std::size_t n = 0; n < y.size() / 3; n += 7)
    for (std::size_t i = 0; i < 3; ++i) {
      if (p.layout.constrained[3 * n + i]) continue;
      std::fill(x.begin(), x.end(), 0.0f);
      x[3 * n + i] = 1;
      level.apply(x.data(), y.data());
      for (std::size_t k = 0; k < y.size(); ++k)
        if (k / 3 != n) y[k] = 0;
      level.apply_inverse_diagonal(y.data(), z.data());
      for (std::size_t k = 0; k < y.size(); ++k)
        EXPECT_NEAR(z[k], k == 3 * n + i ? 1 : 0, 1e-4) << n << " " << i << " " << k;
    }
}

TEST(VertexLevel, ProlongsLinearFieldsAndGivesTheGalerkinProduct) {
  LinearProblemOptions o;
  o.cells = 3;
  o.resistance = 1;
  const LinearProblem p = make_linear_problem(PETSC_COMM_WORLD, o);
  LinearLayout free = p.layout;
  std::fill(free.constrained.begin(), free.constrained.end(), 0);
  VertexLevel unconstrained(free);
  ASSERT_EQ(unconstrained.global_vertices(), 64);
  const auto field = [](const double* x, int a) {
    return 1 + a + (2 + a) * x[0] - x[1] + 3 * x[2];
  };
  const std::vector<double>& at = unconstrained.coordinates();
  std::vector<double> coarse(at.size());
  std::vector<float> fine(p.layout.displacements());
  for (std::size_t i = 0; i < at.size(); ++i)
    coarse[i] = field(&at[i / 3 * 3], static_cast<int>(i % 3));
  unconstrained.prolong(coarse.data(), fine.data());
  for (std::size_t i = 0; i < fine.size(); ++i)
    EXPECT_NEAR(fine[i], field(&free.coordinates[i / 3 * 3], static_cast<int>(i % 3)), 1e-6);

  // P^T A P x = P^T (A (P x)) for a vector x that is zero at constrained dofs.
  VertexLevel level(p.layout);
  KrylovOperator krylov(p.layout);
  krylov.set(p.blocks());
  FineLevel operators(p.layout);
  operators.set(krylov);
  std::vector<float> px(operators.local_dofs()), apx(operators.dofs());
  level.prolong(coarse.data(), px.data());
  operators.apply(px.data(), apx.data());
  std::vector<double> expected(coarse.size()), y(coarse.size());
  level.restrict_to(apx.data(), expected.data());
  const Mat galerkin = level.galerkin(operators);
  VecHandle vx, vy;
  check(MatCreateVecs(galerkin, vx.out(), vy.out()));
  check(VecPlaceArray(vx.get(), coarse.data()));
  check(VecPlaceArray(vy.get(), y.data()));
  check(MatMult(galerkin, vx.get(), vy.get()));
  double scale = 0;
  for (double f : expected) scale = std::max(scale, std::abs(f));
  scale = maximum(PETSC_COMM_WORLD, scale);
  EXPECT_GT(scale, 1);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double* x = &at[i / 3 * 3];
    const auto a = static_cast<int>(i % 3);
    const bool fixed = x[a] < 1e-9 || (a > 0 && x[a] > 1 - 1e-9);
    EXPECT_NEAR(y[i], fixed ? coarse[i] : expected[i], fixed ? 1e-12 : 1e-5 * scale) << i;
  }
}

}  // namespace
}  // namespace polyslip::solver
