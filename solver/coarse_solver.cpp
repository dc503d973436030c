#include "solver/coarse_solver.hpp"

#include <algorithm>

#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

void attach_rigid_body_modes(Mat A, const std::vector<double>& coordinates) {
  VecHandle x;
  check(MatCreateVecs(A, x.out(), nullptr));
  check(VecSetBlockSize(x.get(), 3));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(x.get(), &values));
  std::copy(coordinates.begin(), coordinates.end(), values);
  check(VecRestoreArrayWrite(x.get(), &values));
  NullSpaceHandle modes;
  check(MatNullSpaceCreateRigidBody(x.get(), modes.out()));
  check(MatSetNearNullSpace(A, modes.get()));
}

}  // namespace

void CoarseSolver::create(Mat A, const std::vector<double>& coordinates) {
  matrix_ = MatHandle::share(A);
  check(MatCreateVecs(A, rhs_.out(), solution_.out()));
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(A));
  check(KSPCreate(comm, ksp_.out()));
  PC pc = nullptr;
  check(KSPGetPC(ksp_.get(), &pc));
  PetscInt dofs = 0;
  check(MatGetSize(A, &dofs, nullptr));
  if (dofs <= settings_.max_direct_dofs) {
    check(KSPSetType(ksp_.get(), KSPPREONLY));
    if (size_of(comm) > 1) {
      check(PCSetType(pc, PCREDUNDANT));
      KSP inner = nullptr;
      check(PCRedundantGetKSP(pc, &inner));
      check(KSPGetPC(inner, &pc));
    }
    check(PCSetType(pc, PCLU));
    check(PCFactorSetMatSolverType(pc, MATSOLVERPETSC));
    check(PCFactorSetMatOrderingType(pc, MATORDERINGND));
    return;
  }
  attach_rigid_body_modes(A, coordinates);
  if (settings_.iterations > 1) {
    check(KSPSetType(ksp_.get(), KSPGMRES));
    check(KSPSetNormType(ksp_.get(), KSP_NORM_NONE));
    check(KSPSetTolerances(ksp_.get(), PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT,
                           settings_.iterations));
  } else {
    check(KSPSetType(ksp_.get(), KSPPREONLY));
  }
  check(PCSetType(pc, PCGAMG));
  check(PCGAMGSetType(pc, PCGAMGAGG));
  check(PCGAMGSetNSmooths(pc, settings_.prolongation_smoothings));
  check(PCGAMGSetAggressiveLevels(pc, settings_.aggressive_levels));
  PetscReal threshold = settings_.threshold;
  check(PCGAMGSetThreshold(pc, &threshold, 1));
  check(PCGAMGSetReuseInterpolation(pc, PETSC_TRUE));
}

void CoarseSolver::set_matrix(Mat A, const std::vector<double>& coordinates) {
  if (matrix_.get() != A) create(A, coordinates);
  check(KSPSetOperators(ksp_.get(), A, A));
  check(KSPSetUp(ksp_.get()));
}

void CoarseSolver::solve(const double* b, double* x) {
  check(VecPlaceArray(rhs_.get(), b));
  check(VecPlaceArray(solution_.get(), x));
  check(KSPSolve(ksp_.get(), rhs_.get(), solution_.get()));
  check(VecResetArray(rhs_.get()));
  check(VecResetArray(solution_.get()));
}

}  // namespace polyslip::solver
