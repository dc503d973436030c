#include "solver/multigrid.hpp"

namespace polyslip::solver {

void Multigrid::set_matrix(Mat A) {
  if (matrix_.get() != A) {
    matrix_ = MatHandle::share(A);
    check(MatCreateVecs(A, nullptr, residual_.out()));
    coarse_rhs_.assign(3 * vertices_.nodes(), 0.0);
    coarse_solution_.assign(3 * vertices_.nodes(), 0.0);
  }
  smoother_.set_matrix(A);
  coarse_.set_matrix(vertices_.galerkin(A), vertices_.coordinates());
}

void Multigrid::apply(Vec b, Vec x) {
  smoother_.smooth(b, x, settings_.sweeps_before, true);
  const PetscScalar* residual = nullptr;
  if (settings_.sweeps_before > 0) {
    check(MatMult(matrix_.get(), x, residual_.get()));
    check(VecAYPX(residual_.get(), -1, b));
  }
  const Vec r = settings_.sweeps_before > 0 ? residual_.get() : b;
  check(VecGetArrayRead(r, &residual));
  vertices_.restrict_to(residual, coarse_rhs_.data());
  check(VecRestoreArrayRead(r, &residual));
  coarse_.solve(coarse_rhs_.data(), coarse_solution_.data());
  PetscScalar* correction = nullptr;
  check(VecGetArray(x, &correction));
  vertices_.prolong_add(coarse_solution_.data(), correction);
  check(VecRestoreArray(x, &correction));
  smoother_.smooth(b, x, settings_.sweeps_after, false);
}

}  // namespace polyslip::solver
