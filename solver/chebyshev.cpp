#include "solver/chebyshev.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

/// A number in [-1, 1) that depends on the index only (mixing function of SplitMix64: Steele, Lea,
/// Flood, OOPSLA 2014).
double noise(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

void fill_with_noise(Vec v) {
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(v, &first, &last));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(v, &values));
  for (PetscInt i = first; i < last; ++i) values[i - first] = noise(static_cast<std::uint64_t>(i));
  check(VecRestoreArrayWrite(v, &values));
}

}  // namespace

void Chebyshev::set_matrix(Mat A) {
  if (matrix_.get() != A) {
    matrix_ = MatHandle::share(A);
    check(MatCreateVecs(A, residual_.out(), scaled_.out()));
    check(VecDuplicate(residual_.get(), direction_.out()));
    check(PCCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), jacobi_.out()));
    check(PCSetType(jacobi_.get(), PCPBJACOBI));
  }
  check(PCSetOperators(jacobi_.get(), A, A));
  check(PCSetUp(jacobi_.get()));
  largest_ = settings_.safety * estimate_largest_eigenvalue();
}

double Chebyshev::estimate_largest_eigenvalue() {
  KspHandle ksp;
  const int steps = settings_.arnoldi_steps;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix_.get())), ksp.out()));
  check(KSPSetType(ksp.get(), KSPGMRES));
  check(KSPSetOperators(ksp.get(), matrix_.get(), matrix_.get()));
  check(KSPSetPC(ksp.get(), jacobi_.get()));
  check(KSPSetTolerances(ksp.get(), 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, steps));
  check(KSPGMRESSetRestart(ksp.get(), steps));
  check(KSPSetComputeEigenvalues(ksp.get(), PETSC_TRUE));
  fill_with_noise(residual_.get());
  check(KSPSolve(ksp.get(), residual_.get(), direction_.get()));
  std::vector<PetscReal> real(steps), imaginary(steps);
  PetscInt count = 0;
  check(KSPComputeEigenvalues(ksp.get(), steps, real.data(), imaginary.data(), &count));
  double largest = 0;
  for (PetscInt i = 0; i < count; ++i)
    largest = std::max(largest, std::hypot(real[i], imaginary[i]));
  if (!(largest > 0)) throw core::InternalError("Chebyshev: no positive eigenvalue was found");
  return largest;
}

void Chebyshev::smooth(Vec b, Vec x, int sweeps, bool zero_guess) {
  if (sweeps == 0) {
    if (zero_guess) check(VecZeroEntries(x));
    return;
  }
  const double centre = 0.5 * largest_ * (1 + settings_.lower);
  const double half_width = 0.5 * largest_ * (1 - settings_.lower);
  const double sigma = centre / half_width;
  const Vec r = residual_.get(), z = scaled_.get(), d = direction_.get();
  if (zero_guess) {
    check(VecCopy(b, r));
    check(VecZeroEntries(x));
  } else {
    check(MatMult(matrix_.get(), x, r));
    check(VecAYPX(r, -1, b));
  }
  check(PCApply(jacobi_.get(), r, z));
  check(VecCopy(z, d));
  check(VecScale(d, 1 / centre));
  double rho = 1 / sigma;
  for (int sweep = 1;; ++sweep) {
    check(VecAXPY(x, 1, d));
    if (sweep == sweeps) return;
    check(MatMult(matrix_.get(), d, z));
    check(VecAXPY(r, -1, z));
    check(PCApply(jacobi_.get(), r, z));
    const double next = 1 / (2 * sigma - rho);
    check(VecAXPBY(d, 2 * next / half_width, next * rho, z));
    rho = next;
  }
}

}  // namespace polyslip::solver
