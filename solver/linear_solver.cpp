#include "solver/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "solver/exchange.hpp"
#include "solver/fgmres.hpp"

namespace polyslip::solver {

struct LinearSolver::Impl {
  LinearLayout layout;
  LinearSettings settings;
  std::size_t displacements, pressures;
  KrylovOperator fine;
  FlexibleGmres gmres;
  std::optional<Multigrid> multigrid;
  bool set = false;
  bool usable = true;  // no NaN in the blocks
  bool slow = false;
  double first_rate = 0;  // of convergence on the present aggregates; 0: not known yet
  std::vector<double> rhs, solution, pressure;
  std::vector<float> push, corrected;

  Impl(LinearLayout l, const LinearSettings& s)
      : layout(std::move(l)),
        settings(s),
        displacements(layout.displacements()),
        pressures(layout.pressures()),
        fine(layout),
        gmres(layout.local->comm, displacements + pressures, layout.exchange->profile()),
        rhs(displacements + pressures),
        solution(rhs.size()),
        pressure(pressures),
        push(pressures),
        corrected(displacements) {}

  void apply_preconditioner(const double* v, float* z);
  bool finite(const LinearBlocks& blocks);
  void set_right_side(Vec ru, Vec rp);
  void set_guess(Vec du, Vec dp);
  void judge(const FlexibleGmres::Report& report);
  LinearReport solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance, int max_iterations,
                     bool guessed);
};

/// z_p = -S^-1 v_p, z_u = V-cycle(v_u - B^T (1 - W C) z_p).
void LinearSolver::Impl::apply_preconditioner(const double* v, float* z) {
  const LinearBlocks& b = fine.blocks();
  for (std::size_t e = 0; e < pressures; ++e) {
    const double zp = -v[displacements + e] / b.schur[e];
    z[displacements + e] = static_cast<float>(zp);
    push[e] = static_cast<float>(-(1 - b.W[e] * b.C[e]) * zp);
  }
  // Scaled to entries of order 1 / sqrt(n) by the Krylov method: no underflow in single precision.
  std::vector<float>& r = corrected;
  for (std::size_t i = 0; i < displacements; ++i) r[i] = static_cast<float>(v[i]);
  if (layout.mixed) multigrid->fine().add_volume_forces(push, r.data(), r.data());
  multigrid->apply(r.data(), z);
}

LinearSolver::LinearSolver(LinearLayout layout, const LinearSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(layout), settings)) {}

LinearSolver::~LinearSolver() = default;

bool LinearSolver::Impl::finite(const LinearBlocks& blocks) {
  double total = 0;
  bool positive = true;
  for (float d : multigrid->fine().inverse_diagonal()) total += std::abs(d);
  for (std::size_t e = 0; e < pressures; ++e) {
    total += std::abs(blocks.C[e]) + std::abs(blocks.W[e]) + std::abs(blocks.schur[e]);
    positive = positive && blocks.schur[e] > 0;
  }
  return maximum(layout.local->comm, positive && std::isfinite(total) ? 0 : 1) == 0;
}

void LinearSolver::set_blocks(const LinearBlocks& blocks) {
  Impl& s = *impl_;
  const bool mixed = blocks.scale && blocks.C && blocks.W && blocks.schur;
  const bool resisted = blocks.kappa == 0 || (blocks.reference && blocks.departure);
  const bool complete = blocks.x && blocks.stress && blocks.tangent && blocks.mean_stress &&
                        resisted && (mixed || !s.layout.mixed);
  if (!complete && s.layout.local->element_count() > 0)
    throw core::InternalError("LinearSolver: a block is missing");
  const Stage stage(s.layout.exchange->profile(), "linear set-up");
  s.fine.set(blocks);
  s.set = true;
  if (!s.multigrid) s.multigrid.emplace(s.layout, s.settings.multigrid);
  s.multigrid->set(s.fine);
  s.usable = s.finite(blocks);
  if (!s.usable) return;
  if (s.slow) {
    s.multigrid->renew_hierarchy();
    s.first_rate = 0;
    s.slow = false;
  }
  s.multigrid->renew_below(s.settings.kept_change);
}

void LinearSolver::Impl::set_right_side(Vec ru, Vec rp) {
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(ru, &values));
  std::copy_n(values, displacements, rhs.begin());
  check(VecRestoreArrayRead(ru, &values));
  if (!layout.mixed) return;
  check(VecGetArrayRead(rp, &values));
  std::copy_n(values, pressures, rhs.begin() + static_cast<std::ptrdiff_t>(displacements));
  for (std::size_t e = 0; e < pressures; ++e) pressure[e] = fine.blocks().W[e] * values[e];
  check(VecRestoreArrayRead(rp, &values));
  fine.add_volume_forces(pressure.data(), rhs.data());
}

void LinearSolver::Impl::set_guess(Vec du, Vec dp) {
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(du, &values));
  std::copy_n(values, displacements, solution.begin());
  check(VecRestoreArrayRead(du, &values));
  if (!layout.mixed) return;
  check(VecGetArrayRead(dp, &values));
  std::copy_n(values, pressures, solution.begin() + static_cast<std::ptrdiff_t>(displacements));
  check(VecRestoreArrayRead(dp, &values));
}

/// Notes whether convergence has slowed down since the aggregates were made.
void LinearSolver::Impl::judge(const FlexibleGmres::Report& report) {
  if (report.iterations == 0) return;
  const double rate = -std::log(report.residual / report.start) / report.iterations;
  if (!std::isfinite(rate)) return;
  if (first_rate == 0) first_rate = rate;
  if (!(rate >= settings.renewal_rate * first_rate)) slow = true;
}

LinearReport LinearSolver::solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance,
                                 int max_iterations) {
  return impl_->solve(ru, rp, du, dp, tolerance, max_iterations, false);
}

LinearReport LinearSolver::improve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance,
                                   int max_iterations) {
  return impl_->solve(ru, rp, du, dp, tolerance, max_iterations, true);
}

LinearReport LinearSolver::Impl::solve(Vec ru, Vec rp, Vec du, Vec dp, double tolerance,
                                       int max_iterations, bool guessed) {
  if (!set) throw core::InternalError("LinearSolver: solve before set_blocks");
  const Stage stage(layout.exchange->profile(), "linear solver");
  set_right_side(ru, rp);
  const double norm = gmres.norm(rhs.data());
  LinearReport report;
  report.right_side = norm;
  if (!usable || !std::isfinite(norm)) {
    check(VecSet(du, std::nan("")));
    if (layout.mixed) check(VecSet(dp, std::nan("")));
    report.relative_residual = std::nan("");
    return report;
  }
  const std::size_t n = displacements;
  const auto A = [&](const double* x, double* y) { fine.apply(x, x + n, y, y + n); };
  const auto M = [&](const double* v, float* z) { apply_preconditioner(v, z); };
  if (guessed) set_guess(du, dp);
  const auto result =
      guessed ? gmres.improve(A, M, rhs.data(), solution.data(), tolerance, max_iterations)
              : gmres.solve(A, M, rhs.data(), solution.data(), tolerance, max_iterations);
  report.iterations = result.iterations;
  report.converged = result.converged;
  report.relative_residual = norm > 0 ? result.residual / norm : 0;
  judge(result);

  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(du, &values));
  std::copy_n(solution.begin(), n, values);
  check(VecRestoreArrayWrite(du, &values));
  if (!layout.mixed) return report;
  check(VecGetArrayWrite(dp, &values));
  std::copy(solution.begin() + static_cast<std::ptrdiff_t>(n), solution.end(), values);
  check(VecRestoreArrayWrite(dp, &values));
  return report;
}

void LinearSolver::drop_setup() {
  Impl& s = *impl_;
  s.multigrid.reset();
  s.gmres.release();
  s.first_rate = 0;
  s.slow = false;
  s.set = false;
}

}  // namespace polyslip::solver
