#include "solver/linear_solver.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <optional>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

using Form = LinearSettings::Form;

/// Runs `action` inside a PETSc callback: what it throws is kept for after the solve.
template <class Action>
PetscErrorCode guarded(std::exception_ptr& failure, Action action) {
  try {
    action();
    return 0;
  } catch (...) {
    failure = std::current_exception();
    return PETSC_ERR_LIB;
  }
}

/// The displacement and pressure parts of a vector [u; p] of this rank, without copies.
class Parts {
 public:
  Parts(const LinearLayout& layout) : offset_(3 * layout.local_nodes) {
    check(VecCreateMPIWithArray(layout.comm, 3, offset_, PETSC_DETERMINE, nullptr, u_.out()));
    check(VecCreateMPIWithArray(layout.comm, 1, layout.local_pressures, PETSC_DETERMINE, nullptr,
                                p_.out()));
  }
  void place(const PetscScalar* values) {
    check(VecPlaceArray(u_.get(), values));
    check(VecPlaceArray(p_.get(), values + offset_));
  }
  void take_back() {
    check(VecResetArray(u_.get()));
    check(VecResetArray(p_.get()));
  }
  Vec u() const { return u_.get(); }
  Vec p() const { return p_.get(); }

 private:
  PetscInt offset_;
  VecHandle u_, p_;
};

/// y = a x, elementwise. The pressures' vectors are short and local.
void multiply(Vec y, Vec a, Vec x) { check(VecPointwiseMult(y, a, x)); }

}  // namespace

struct LinearSolver::Impl {
  LinearLayout layout;
  LinearSettings settings;
  bool mixed = false;
  bool usable = true;  // no NaN in the blocks
  std::exception_ptr failure;

  MatHandle A, A_augmented, B;
  VecHandle C, W, schur;
  VecHandle coupling;  // 1 - W C
  VecHandle work_p, work_u;
  Parts in, out;
  MatHandle operator_shell;
  KspHandle ksp;
  VecHandle rhs, solution;
  std::optional<Multigrid> multigrid;
  double first_rate = 0;  // of convergence on the present aggregates; 0: not known yet
  bool slow = false;

  Impl(LinearLayout l, const LinearSettings& s)
      : layout(std::move(l)), settings(s), in(layout), out(layout) {
    PetscInt pressures = 0;
    check(VecGetSize(in.p(), &pressures));
    mixed = pressures > 0;
    const PetscInt rows = 3 * layout.local_nodes + layout.local_pressures;
    check(MatCreateShell(layout.comm, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, this,
                         operator_shell.out()));
    check(MatShellSetOperation(operator_shell.get(), MATOP_MULT,
                               reinterpret_cast<void (*)()>(&Impl::multiply_callback)));
    check(MatCreateVecs(operator_shell.get(), rhs.out(), solution.out()));
    check(VecDuplicate(in.u(), work_u.out()));
    check(VecDuplicate(in.p(), work_p.out()));
  }

  void create_ksp() {
    check(KSPCreate(layout.comm, ksp.out()));
    check(KSPSetType(ksp.get(), KSPFGMRES));
    check(KSPSetOperators(ksp.get(), operator_shell.get(), operator_shell.get()));
    check(KSPGMRESSetCGSRefinementType(ksp.get(), KSP_GMRES_CGS_REFINE_IFNEEDED));
    PC pc = nullptr;
    check(KSPGetPC(ksp.get(), &pc));
    check(PCSetType(pc, PCSHELL));
    check(PCShellSetContext(pc, this));
    check(PCShellSetApply(pc, &Impl::precondition_callback));
  }

  template <class Action>
  void with_parts(Vec x, Vec y, Action action) {
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    check(VecGetArrayRead(x, &from));
    check(VecGetArrayWrite(y, &to));
    in.place(from);
    out.place(to);
    action();
    in.take_back();
    out.take_back();
    check(VecRestoreArrayWrite(y, &to));
    check(VecRestoreArrayRead(x, &from));
  }

  void apply_operator() {
    const bool augmented = !mixed || settings.form == Form::augmented;
    check(MatMult((augmented ? A_augmented : A).get(), in.u(), out.u()));
    if (!mixed) return;
    const Vec t = work_p.get();
    if (augmented) {
      multiply(t, coupling.get(), in.p());
    } else {
      check(VecCopy(in.p(), t));
    }
    check(MatMultTransposeAdd(B.get(), t, out.u(), out.u()));
    multiply(t, C.get(), in.p());
    check(MatMult(B.get(), in.u(), out.p()));
    check(VecAXPY(out.p(), -1, t));
  }

  /// y_p = -S^-1 x_p, y_u = V-cycle(x_u [+ B^T W x_p] - B^T (1 [- W C]) y_p).
  void apply_preconditioner() {
    if (!mixed) {
      multigrid->apply(in.u(), out.u());
      return;
    }
    check(VecPointwiseDivide(out.p(), in.p(), schur.get()));  // -y_p
    const Vec t = work_p.get();
    if (settings.form == Form::original) {
      check(VecCopy(out.p(), t));
    } else {
      multiply(t, coupling.get(), out.p());
    }
    check(VecScale(out.p(), -1));
    check(MatMultTransposeAdd(B.get(), t, in.u(), work_u.get()));
    if (settings.form == Form::original_transformed) {
      multiply(t, W.get(), in.p());
      check(MatMultTransposeAdd(B.get(), t, work_u.get(), work_u.get()));
    }
    multigrid->apply(work_u.get(), out.u());
  }

  static PetscErrorCode multiply_callback(Mat shell, Vec x, Vec y) {
    void* self = nullptr;
    if (const PetscErrorCode code = MatShellGetContext(shell, &self)) return code;
    auto& impl = *static_cast<Impl*>(self);
    return guarded(impl.failure, [&] { impl.with_parts(x, y, [&] { impl.apply_operator(); }); });
  }
  static PetscErrorCode precondition_callback(PC pc, Vec x, Vec y) {
    void* self = nullptr;
    if (const PetscErrorCode code = PCShellGetContext(pc, &self)) return code;
    auto& impl = *static_cast<Impl*>(self);
    return guarded(impl.failure,
                   [&] { impl.with_parts(x, y, [&] { impl.apply_preconditioner(); }); });
  }

  void check_sizes(const LinearBlocks& blocks) const;
  void take_matrix(Mat given, MatHandle& held);
  bool finite() const;
  void set_right_side(Vec ru, Vec rp);
  LinearReport run_ksp(double norm, double tolerance, int max_iterations);
  void judge(const LinearReport& report);
};

LinearSolver::LinearSolver(LinearLayout layout, const LinearSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(layout), settings)) {}

LinearSolver::~LinearSolver() = default;

void LinearSolver::Impl::check_sizes(const LinearBlocks& blocks) const {
  PetscInt rows = -1, pressures = -1, columns = -1, c = -1, w = -1, s = -1;
  const bool needs_A = mixed && settings.form != Form::augmented;
  if (!blocks.A_augmented || (needs_A && !blocks.A)) {
    throw core::InternalError("LinearSolver: the displacement block is missing");
  }
  check(MatGetLocalSize(blocks.A_augmented, &rows, nullptr));
  if (rows != 3 * layout.local_nodes) {
    throw core::InternalError(fmt::format(
        "LinearSolver: A_augmented has {} local rows for {} nodes", rows, layout.local_nodes));
  }
  if (!mixed) return;
  if (!blocks.B || !blocks.C || !blocks.W || !blocks.schur) {
    throw core::InternalError("LinearSolver: a block of the pressures is missing");
  }
  check(MatGetLocalSize(blocks.B, &pressures, &columns));
  check(VecGetLocalSize(blocks.C, &c));
  check(VecGetLocalSize(blocks.W, &w));
  check(VecGetLocalSize(blocks.schur, &s));
  const PetscInt n = layout.local_pressures;
  if (pressures != n || columns != rows || c != n || w != n || s != n) {
    throw core::InternalError(
        fmt::format("LinearSolver: {} pressures, but B is {} x {}, C, W, schur have {}, {}, {}", n,
                    pressures, columns, c, w, s));
  }
}

/// BAIJ as it is, else a copy in that format.
void LinearSolver::Impl::take_matrix(Mat given, MatHandle& held) {
  PetscBool is_baij = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(given), &is_baij, MATSEQBAIJ,
                                  MATMPIBAIJ, ""));
  if (is_baij) {
    held = MatHandle::share(given);
  } else if (held) {
    check(MatConvert(given, MATBAIJ, MAT_REUSE_MATRIX, held.in_out()));
  } else {
    check(MatConvert(given, MATBAIJ, MAT_INITIAL_MATRIX, held.out()));
  }
}

bool LinearSolver::Impl::finite() const {
  PetscReal norm = 0, sum = 0;
  check(MatNorm(A_augmented.get(), NORM_FROBENIUS, &norm));
  sum += norm;
  if (mixed) {
    check(MatNorm(B.get(), NORM_FROBENIUS, &norm));
    sum += norm;
    for (const Vec v : {C.get(), W.get(), schur.get()}) {
      check(VecNorm(v, NORM_2, &norm));
      sum += norm;
    }
    check(VecMin(schur.get(), nullptr, &norm));
    if (norm <= 0) return false;
  }
  return std::isfinite(sum);
}

void LinearSolver::set_blocks(const LinearBlocks& blocks) {
  Impl& s = *impl_;
  s.check_sizes(blocks);
  s.take_matrix(blocks.A_augmented, s.A_augmented);
  if (s.mixed) {
    if (blocks.A) s.A = MatHandle::share(blocks.A);
    s.B = MatHandle::share(blocks.B);
    s.C = VecHandle::share(blocks.C);
    s.W = VecHandle::share(blocks.W);
    s.schur = VecHandle::share(blocks.schur);
    check(VecDuplicate(blocks.C, s.coupling.out()));
    multiply(s.coupling.get(), blocks.W, blocks.C);
    check(VecScale(s.coupling.get(), -1));
    check(VecShift(s.coupling.get(), 1));
  }
  s.usable = s.finite();
  if (!s.usable) return;
  if (!s.multigrid) s.multigrid.emplace(s.layout, s.settings.multigrid);
  if (s.slow) {
    s.multigrid->renew_hierarchy();
    s.first_rate = 0;
    s.slow = false;
  }
  s.multigrid->set_matrix(s.A_augmented.get());
}

void LinearSolver::Impl::set_right_side(Vec ru, Vec rp) {
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(rhs.get(), &values));
  out.place(values);
  check(VecCopy(ru, out.u()));
  if (mixed) {
    check(VecCopy(rp, out.p()));
    if (settings.form == Form::augmented) {
      multiply(work_p.get(), W.get(), rp);
      check(MatMultTransposeAdd(B.get(), work_p.get(), out.u(), out.u()));
    }
  }
  out.take_back();
  check(VecRestoreArrayWrite(rhs.get(), &values));
}

/// `norm`: that of the right side.
LinearReport LinearSolver::Impl::run_ksp(double norm, double tolerance, int max_iterations) {
  create_ksp();
  check(KSPGMRESSetRestart(ksp.get(), max_iterations));
  check(KSPSetTolerances(ksp.get(), tolerance, 1e-300, 1e10, max_iterations));
  const PetscErrorCode code = KSPSolve(ksp.get(), rhs.get(), solution.get());
  if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
  check(code);
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscReal residual = 0;
  check(KSPGetConvergedReason(ksp.get(), &reason));
  check(KSPGetIterationNumber(ksp.get(), &iterations));
  check(KSPGetResidualNorm(ksp.get(), &residual));
  LinearReport report;
  report.iterations = static_cast<int>(iterations);
  report.converged = reason > 0;
  report.relative_residual = norm > 0 ? residual / norm : 0;
  return report;
}

/// Notes whether convergence has slowed down since the aggregates were made.
void LinearSolver::Impl::judge(const LinearReport& report) {
  if (report.iterations == 0) return;
  const double rate = -std::log(report.relative_residual) / report.iterations;
  if (!std::isfinite(rate)) return;
  if (first_rate == 0) first_rate = rate;
  if (!(rate >= settings.renewal_rate * first_rate)) slow = true;
}

LinearReport LinearSolver::solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance,
                                 int max_iterations) {
  Impl& s = *impl_;
  if (!s.A_augmented) throw core::InternalError("LinearSolver: solve before set_blocks");
  s.set_right_side(ru, rp);
  PetscReal norm = 0;
  check(VecNorm(s.rhs.get(), NORM_2, &norm));
  LinearReport report;
  if (!s.usable || !std::isfinite(norm)) {
    check(VecSet(du, std::nan("")));
    if (s.mixed) check(VecSet(dp, std::nan("")));
    report.relative_residual = std::nan("");
    return report;
  }
  report = s.run_ksp(norm, tolerance, max_iterations);
  s.judge(report);

  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(s.solution.get(), &values));
  s.in.place(values);
  check(VecCopy(s.in.u(), du));
  if (s.mixed) check(VecCopy(s.in.p(), dp));
  s.in.take_back();
  check(VecRestoreArrayRead(s.solution.get(), &values));
  return report;
}

void LinearSolver::drop_setup() {
  Impl& s = *impl_;
  s.multigrid.reset();
  s.first_rate = 0;
  s.slow = false;
  s.ksp.reset();
  for (MatHandle* m : {&s.A, &s.A_augmented, &s.B}) m->reset();
  for (VecHandle* v : {&s.C, &s.W, &s.schur, &s.coupling}) v->reset();
}

}  // namespace polyslip::solver
