// What PETSc offers for a Newton step, and this program's solver, on one and the same real
// polycrystal (docs/benchmarks.md): displacement form, pressures condensed, assembled. Iterations
// to four tolerances, CPU seconds of the set-up and of two of the solves. One rank.
//   petsc_solvers [--elements 3000] [--bulk-to-shear 250] [--only TEXT]
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/timer.hpp"
#include "solver/exchange.hpp"
#include "solver/linear_solver.hpp"
#include "solver/petsc_session.hpp"
#include "support/polycrystal_mesh.hpp"
#include "support/solver/linear_problem.hpp"

namespace {

using namespace polyslip;
using solver::check;
using test::LinearProblem;

constexpr std::array tolerances{1e-2, 1e-3, 1e-6, 1e-8};
constexpr int most_iterations = 5000;

/// A solver of PETSc's, by its options.
struct Candidate {
  const char* name;
  const char* options;
};

constexpr Candidate candidates[] = {
    {"CG, Jacobi", "-ksp_type cg -pc_type jacobi"},
    {"CG, incomplete Cholesky", "-ksp_type cg -pc_type icc"},
    {"CG, GAMG, rigid-body modes", "-ksp_type cg -pc_type gamg"},
    {"CG, BoomerAMG",
     "-ksp_type cg -pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_nodal_coarsen 4 "
     "-pc_hypre_boomeramg_strong_threshold 0.5"},
    {"MUMPS, Cholesky", "-ksp_type preonly -pc_type cholesky -pc_factor_mat_solver_type mumps"},
};

struct Row {
  std::string name;
  double set_up = 0;
  std::array<int, 4> iterations{};
  std::array<bool, 4> converged{};
  std::array<double, 4> seconds{};
};

void print(const Row& row) {
  std::string text = fmt::format("| {} | {:.2f} |", row.name, row.set_up);
  for (std::size_t t = 0; t < tolerances.size(); ++t)
    text +=
        fmt::format("{} {}{}", t > 0 ? " /" : "", row.iterations[t], row.converged[t] ? "" : "+");
  fmt::print("{} | {:.2f} | {:.2f} |\n", text, row.seconds[0], row.seconds[2]);
}

Row measure_own(const LinearProblem& p) {
  Row row{"**this program's**", 0, {}, {}, {}};
  double start = core::process_cpu_seconds();
  solver::LinearSolver linear(p.layout);
  linear.set_blocks(p.blocks());
  row.set_up = core::process_cpu_seconds() - start;
  for (std::size_t t = 0; t < tolerances.size(); ++t) {
    start = core::process_cpu_seconds();
    const auto report =
        linear.solve(p.ru.get(), p.rp.get(), p.du.get(), p.dp.get(), tolerances[t], 400);
    row.iterations[t] = report.iterations;
    row.converged[t] = report.converged;
    row.seconds[t] = core::process_cpu_seconds() - start;
  }
  return row;
}

/// A + B^T C^-1 B, and the right side that goes with it.
struct Condensed {
  solver::MatHandle matrix;
  solver::VecHandle right_side, solution;
};

void attach_modes(const LinearProblem& p, Mat matrix) {
  solver::VecHandle x;
  solver::NullSpaceHandle modes;
  check(MatCreateVecs(matrix, x.out(), nullptr));
  check(VecSetBlockSize(x.get(), 3));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(x.get(), &values));
  std::copy(p.layout.coordinates.begin(), p.layout.coordinates.end(), values);
  check(VecRestoreArrayWrite(x.get(), &values));
  check(MatNullSpaceCreateRigidBody(x.get(), modes.out()));
  check(MatSetNearNullSpace(matrix, modes.get()));
}

Condensed condense(const LinearProblem& p) {
  Condensed c;
  const solver::LocalMesh& local = p.mesh->local();
  const PetscInt n = 3 * local.owned_nodes;
  check(MatCreate(PETSC_COMM_SELF, c.matrix.out()));
  check(MatSetSizes(c.matrix.get(), n, n, n, n));
  check(MatSetType(c.matrix.get(), MATSEQAIJ));
  check(MatSetBlockSize(c.matrix.get(), 3));
  check(MatSeqAIJSetPreallocation(c.matrix.get(), 400, nullptr));
  check(MatSetOption(c.matrix.get(), MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  check(MatCreateVecs(c.matrix.get(), c.solution.out(), c.right_side.out()));
  check(VecCopy(p.ru.get(), c.right_side.get()));
  const PetscScalar* volumes = nullptr;
  check(VecGetArrayRead(p.rp.get(), &volumes));
  for (int e = 0; e < local.element_count(); ++e) {
    solver::ElementMatrix matrix;
    solver::ElementForces b;
    p.element(e, matrix, b);
    const double D = p.scale[e], C = p.C[e];
    std::array<PetscInt, 10> nodes{};
    std::array<PetscInt, 30> dofs{};
    std::array<PetscScalar, 30> forces{};
    double* k = &matrix[0][0][0][0];
    const double* gradient = &b[0][0];
    for (std::size_t a = 0; a < 10; ++a) nodes[a] = local.elements[e][a];
    for (std::size_t i = 0; i < 30; ++i) {
      dofs[i] = 3 * nodes[i / 3] + static_cast<PetscInt>(i % 3);
      forces[i] = D * gradient[i] * volumes[e] / C;
      for (std::size_t j = 0; j < 30; ++j) k[30 * i + j] += D * D / C * gradient[i] * gradient[j];
    }
    check(MatSetValuesBlocked(c.matrix.get(), 10, nodes.data(), 10, nodes.data(), k, ADD_VALUES));
    check(VecSetValues(c.right_side.get(), 30, dofs.data(), forces.data(), ADD_VALUES));
  }
  check(VecRestoreArrayRead(p.rp.get(), &volumes));
  check(MatAssemblyBegin(c.matrix.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(c.matrix.get(), MAT_FINAL_ASSEMBLY));
  check(VecAssemblyBegin(c.right_side.get()));
  check(VecAssemblyEnd(c.right_side.get()));
  std::vector<PetscInt> fixed;
  for (PetscInt i = 0; i < n; ++i)
    if (p.layout.constrained[i]) fixed.push_back(i);
  check(VecSet(c.solution.get(), 0));
  check(MatZeroRowsColumns(c.matrix.get(), static_cast<PetscInt>(fixed.size()), fixed.data(), 1,
                           c.solution.get(), c.right_side.get()));
  attach_modes(p, c.matrix.get());
  return c;
}

Row measure(const Candidate& candidate, const Condensed& c) {
  Row row{candidate.name, 0, {}, {}, {}};
  check(PetscOptionsClear(nullptr));
  check(PetscOptionsInsertString(nullptr, candidate.options));
  solver::KspHandle ksp;
  double start = core::process_cpu_seconds();
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOperators(ksp.get(), c.matrix.get(), c.matrix.get()));
  check(KSPSetFromOptions(ksp.get()));
  KSPType type = nullptr;
  check(KSPGetType(ksp.get(), &type));
  if (std::string(type) != KSPPREONLY) check(KSPSetNormType(ksp.get(), KSP_NORM_UNPRECONDITIONED));
  check(KSPSetUp(ksp.get()));
  row.set_up = core::process_cpu_seconds() - start;
  for (std::size_t t = 0; t < tolerances.size(); ++t) {
    check(
        KSPSetTolerances(ksp.get(), tolerances[t], PETSC_DEFAULT, PETSC_DEFAULT, most_iterations));
    start = core::process_cpu_seconds();
    check(KSPSolve(ksp.get(), c.right_side.get(), c.solution.get()));
    row.seconds[t] = core::process_cpu_seconds() - start;
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check(KSPGetIterationNumber(ksp.get(), &iterations));
    check(KSPGetConvergedReason(ksp.get(), &reason));
    row.iterations[t] = static_cast<int>(iterations);
    row.converged[t] = reason > 0;
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  double elements = 3000, element_size = 0.5;
  std::string worker = POLYSLIP_BINARY_DIR "/polyslip-mesher", only;
  test::LinearProblemOptions options;
  CLI::App app("Linear solvers on a polycrystal");
  app.add_option("--elements", elements, "About so many")->capture_default_str();
  app.add_option("--bulk-to-shear", options.bulk_to_shear)->capture_default_str();
  app.add_option("--only", only, "Candidates of PETSc's with this in their names; none: own only");
  app.add_option("--worker", worker, "polyslip-mesher");
  CLI11_PARSE(app, argc, argv);
  const auto pool = mesh::MesherPool::start(worker);
  const solver::PetscSession session;
  if (solver::size_of(MPI_COMM_WORLD) > 1) return EXIT_FAILURE;
  mesh::Mesh cube =
      tests::polycrystal_mesh(*pool, tests::grains_for(elements, element_size), element_size);
  for (auto& x : cube.nodes) x = x.cwiseQuotient(cube.size);
  const LinearProblem p = test::make_linear_problem(MPI_COMM_SELF, options, cube);
  fmt::print("{} elements, K / mu = {}\n", cube.element_count(), options.bulk_to_shear);
  fmt::print(
      "| solver | set-up s | iterations to 1e-2 / 1e-3 / 1e-6 / 1e-8 | solve to 1e-2 s | to 1e-6 s "
      "|\n|---|---|---|---|---|\n");
  print(measure_own(p));
  if (only == "none") return EXIT_SUCCESS;
  const Condensed c = condense(p);
  for (const Candidate& candidate : candidates)
    if (std::string(candidate.name).find(only) != std::string::npos) print(measure(candidate, c));
  return EXIT_SUCCESS;
}
