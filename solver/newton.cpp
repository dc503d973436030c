#include "solver/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

VecHandle create_vector(MPI_Comm comm, PetscInt local_size, PetscInt block) {
  VecHandle v;
  check(VecCreate(comm, v.out()));
  check(VecSetSizes(v.get(), local_size, PETSC_DETERMINE));
  check(VecSetBlockSize(v.get(), block));
  check(VecSetType(v.get(), VECSTANDARD));
  check(VecSet(v.get(), 0));
  return v;
}

void from_petsc(Vec from, std::size_t count, std::vector<double>& to) {
  const PetscScalar* array = nullptr;
  check(VecGetArrayRead(from, &array));
  std::copy(array, array + count, to.begin());
  check(VecRestoreArrayRead(from, &array));
}

/// value(i) for each of `count` local entries
template <class Value>
void to_petsc(std::size_t count, const Value& value, Vec to) {
  PetscScalar* array = nullptr;
  check(VecGetArrayWrite(to, &array));
  for (std::size_t i = 0; i < count; ++i) array[i] = value(i);
  check(VecRestoreArrayWrite(to, &array));
}

LinearLayout make_layout(const Discretisation& d, const std::vector<std::uint8_t>& constrained,
                         const std::vector<double>& x) {
  LinearLayout layout;
  layout.local = &d.local();
  layout.exchange = &d.exchange();
  layout.mixed = d.mixed();
  layout.rule = &d.rule();
  layout.coordinates.assign(x.begin(), x.begin() + 3 * static_cast<long>(d.local().owned_nodes));
  layout.constrained = constrained;
  return layout;
}

/// Share of the tolerance on forces below which a linear system need not be solved.
constexpr double margin = 0.3;

/// The larger weight of the augmentation makes the displacements' block harder: more sweeps over a
/// wider interval, and a better solve on the vertex level.
LinearSettings settings_for(double linear_tolerance) {
  LinearSettings settings;
  if (linear_tolerance > tight_tolerance) return settings;
  settings.multigrid.sweeps_after = 16;
  settings.multigrid.smoother.lower = 0.02;
  settings.multigrid.coarse.iterations = 4;
  return settings;
}

}  // namespace

NewtonSolver::NewtonSolver(Discretisation& discretisation, const Boundary& boundary,
                           const SolverOptions& options, const std::vector<double>& x)
    : discretisation_(discretisation),
      boundary_(boundary),
      options_(options),
      constrained_(constrained_dofs(discretisation.local(), boundary)),
      planar_(discretisation.local(), boundary),
      linear_(std::make_unique<LinearSolver>(make_layout(discretisation, constrained_, x),
                                             settings_for(options.linear_tolerance))) {
  const LocalMesh& local = discretisation_.local();
  ru_ = create_vector(local.comm, 3 * local.owned_nodes, 3);
  du_ = create_vector(local.comm, 3 * local.owned_nodes, 3);
  if (discretisation_.mixed()) {
    rp_ = create_vector(local.comm, local.element_count(), 1);
    dp_ = create_vector(local.comm, local.element_count(), 1);
  }
  increment_.assign(3 * static_cast<std::size_t>(local.local_nodes), 0);
  pressure_increment_.assign(local.elements.size(), 0);
  double volume = 0;
  for (double v : discretisation_.reference_volumes()) volume += v;
  length_ = std::cbrt(sum(local.comm, volume));
  floor_force_ = 1e-6 * discretisation_.law().shear_modulus() * length_ * length_;
}

void NewtonSolver::drop_setup(const std::vector<double>& x) {
  linear_.reset();
  linear_ = std::make_unique<LinearSolver>(make_layout(discretisation_, constrained_, x),
                                           settings_for(options_.linear_tolerance));
  responses_.clear();
}

NewtonReport NewtonSolver::solve(const NewtonProblem& problem, std::vector<double>& x,
                                 std::vector<double>& p) {
  NewtonReport report;
  const Evaluation start =
      discretisation_.evaluate(problem.old, x, p, problem.time_step, problem.kappa);
  if (start != Evaluation::fine) {
    report.reason = "predictor: " + describe(start);
    return report;
  }
  update_residual(problem, x);
  report.balance = measure(x);
  moved_ = 0;
  double gain = 1;
  while (!converged(report.balance, problem)) {
    if (report.iterations == options_.max_newton_iterations) {
      report.reason = fmt::format(
          "no convergence in {} Newton iterations (forces out of balance {:.3g} times, the last "
          "increment {:.3g} times what they may be)",
          report.iterations, excess(report.balance), moved_ / options_.velocity_tolerance);
      return report;
    }
    ++report.iterations;
    const Tangent tangent = report.iterations == 1 ? Tangent::of_law : Tangent::secant;
    linear_->set_blocks(
        discretisation_.linearise(augmentation_weight(options_.linear_tolerance), tangent));
    const double before = report.balance.free_norm;
    if (!solve_linear(forcing(report.balance, gain), x, report)) return report;
    const std::vector<double> x0 = x;
    if (!search(problem, report.balance, x, p, report)) return report;
    moved_ = relative_move(x, x0, problem.old.x);
    gain = report.balance.free_norm / before;
  }
  report.converged = true;
  report.reason.clear();
  return report;
}

void NewtonSolver::update_residual(const NewtonProblem& problem, const std::vector<double>& x) {
  residual_ = discretisation_.forces();
  for (std::size_t i = 0; i < problem.external_forces.size(); ++i)
    residual_[i] -= problem.external_forces[i];
  planar_residual_ = planar_.residuals(residual_, x, problem.path);
}

Balance NewtonSolver::measure(const std::vector<double>& x) const {
  return balance(discretisation_.local(), boundary_, constrained_, residual_, x,
                 discretisation_.volumes(), discretisation_.volume_gap());
}

double NewtonSolver::allowed(const Balance& b) const {
  const double scale =
      std::max(b.reaction_norm, floor_force_) / std::sqrt(std::max(b.reaction_dofs, 1.0));
  return options_.newton_tolerance * scale * std::sqrt(b.free_dofs);
}

double NewtonSolver::excess(const Balance& b) const {
  return b.free_norm > 0 ? b.free_norm / allowed(b) : 0;
}

/// Where points' rates change by much Newton's method gains less than a well solved system would
/// give: its square is Eisenstat and Walker's second choice (SIAM J. Sci. Comput. 17, 1996). Nor is
/// more needed than what brings the forces below their tolerance.
double NewtonSolver::forcing(const Balance& b, double gain) const {
  constexpr double first = 0.1, loosest = 0.2, factor = 0.9;
  // relative to a linear_tolerance of 0.01
  const double unit = options_.linear_tolerance / 0.01;
  // What is left then is of long waves, which move much with little force.
  if (planar_.count() > 0 && excess(b) <= 1) return options_.linear_tolerance;
  const double wanted = unit * (gain == 1 ? first : factor * gain * gain);
  return std::clamp(std::max(wanted, margin / std::max(excess(b), 1.0)), options_.linear_tolerance,
                    std::max(loosest * std::min(unit, 1.0), options_.linear_tolerance));
}

bool NewtonSolver::balanced(const Balance& b) const {
  const double t = options_.newton_tolerance;
  const double force = std::max(b.largest_face_force, floor_force_);
  bool fine = excess(b) <= 1;
  for (std::size_t i = 0; i < 3; ++i)
    fine = fine && std::abs(b.resultant[i]) <= t * force &&
           std::abs(b.moment[i]) <= t * force * length_;
  for (double r : planar_residual_) fine = fine && std::abs(r) <= t * force;
  return fine;
}

bool NewtonSolver::converged(const Balance& b, const NewtonProblem& problem) const {
  return balanced(b) && moved_ <= options_.velocity_tolerance &&
         b.volume_gap <= options_.newton_tolerance * std::abs(problem.strain_increment);
}

double NewtonSolver::relative_move(const std::vector<double>& x, const std::vector<double>& x0,
                                   const std::vector<double>& old) const {
  double squares[2] = {0, 0};
  const auto dofs = 3 * static_cast<std::size_t>(discretisation_.local().owned_nodes);
  for (std::size_t i = 0; i < dofs; ++i) {
    squares[0] += (x[i] - x0[i]) * (x[i] - x0[i]);
    squares[1] += (x[i] - old[i]) * (x[i] - old[i]);
  }
  sum(discretisation_.local().comm, squares, 2);
  return squares[0] > 0 ? std::sqrt(squares[0] / squares[1]) : 0;
}

bool NewtonSolver::solve_linear(double tolerance, const std::vector<double>& x,
                                NewtonReport& report) {
  std::vector<double> forces(residual_.size()), volumes(pressure_increment_.size());
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = -residual_[i];
  for (std::size_t e = 0; e < volumes.size(); ++e)
    volumes[e] = -discretisation_.volumes()[e] * discretisation_.volume_gap()[e];
  increment_.clear();
  LinearReport linear;
  if (!solve_system(tolerance, forces, volumes, increment_, pressure_increment_, linear, report))
    return false;
  double left = tolerance * linear.right_side;
  if (excess(report.balance) > 1) left = std::max(left, margin * allowed(report.balance));
  return add_planar(left, x, report);
}

bool NewtonSolver::solve_system(double tolerance, const std::vector<double>& forces,
                                const std::vector<double>& volumes, std::vector<double>& u,
                                std::vector<double>& p, LinearReport& linear,
                                NewtonReport& report) {
  const LocalMesh& local = discretisation_.local();
  const auto dofs = 3 * static_cast<std::size_t>(local.owned_nodes);
  const std::size_t elements = local.elements.size();
  const bool mixed = discretisation_.mixed();
  const auto scale = [&](std::size_t e) { return discretisation_.pressure_scale(e); };
  to_petsc(
      dofs, [&](std::size_t i) { return constrained_[i] ? 0 : forces[i]; }, ru_.get());
  if (mixed)
    to_petsc(
        elements, [&](std::size_t e) { return scale(e) * volumes[e]; }, rp_.get());
  const bool guessed = !u.empty();
  if (guessed) {
    to_petsc(
        dofs, [&](std::size_t i) { return constrained_[i] ? 0 : u[i]; }, du_.get());
    if (mixed)
      to_petsc(
          elements, [&](std::size_t e) { return p[e] / scale(e); }, dp_.get());
  }
  linear = guessed ? linear_->improve(ru_.get(), rp_.get(), du_.get(), dp_.get(), tolerance,
                                      options_.max_linear_iterations)
                   : linear_->solve(ru_.get(), rp_.get(), du_.get(), dp_.get(), tolerance,
                                    options_.max_linear_iterations);
  report.linear_iterations += linear.iterations;
  // An increment that is only roughly right still brings Newton's method forward.
  if (!linear.converged && !(linear.relative_residual < 0.5)) {
    report.reason = fmt::format("the linear solver stopped after {} iterations at {:.2g}",
                                linear.iterations, linear.relative_residual);
    return false;
  }
  u.resize(3 * static_cast<std::size_t>(local.local_nodes));
  from_petsc(du_.get(), dofs, u);
  discretisation_.exchange().update_ghosts(u, 3);
  if (mixed) {
    from_petsc(dp_.get(), elements, p);
    for (std::size_t e = 0; e < elements; ++e) p[e] *= scale(e);
  }
  return true;
}

std::vector<double> NewtonSolver::face_forces(const std::vector<double>& u,
                                              const std::vector<double>& p,
                                              std::vector<double>& forces,
                                              std::vector<double>& volumes) const {
  forces.resize(increment_.size());
  volumes.resize(pressure_increment_.size());
  discretisation_.apply_tangent(planar_.elements(), u, p, forces, volumes);
  return planar_.sums(forces);
}

/// The first guess is the stretch of the whole body, whose rest is the measure of what is asked: a
/// unit motion of the face alone strains only the elements at it, by the more the longer the body.
bool NewtonSolver::respond(std::size_t face, double tolerance, const std::vector<double>& x,
                           NewtonReport& report) {
  Response& r = responses_[face];
  const auto unit = planar_.direction(face);
  std::vector<double> forces, volumes;
  face_forces(unit, std::vector<double>(pressure_increment_.size(), 0), forces, volumes);
  for (double& f : forces) f = -f;
  for (double& v : volumes) v = -v;
  LinearReport linear;
  if (r.u.empty()) {
    constexpr double as_it_is = 1e9, least_share = 1e-6;
    r.u = planar_.stretch(face, x);
    r.p.assign(volumes.size(), discretisation_.law().bulk_modulus() / planar_.extent(face, x));
    if (!solve_system(as_it_is, forces, volumes, r.u, r.p, linear, report)) return false;
    r.share = std::clamp(linear.relative_residual, least_share, 1.0);
  }
  if (!solve_system(tolerance * r.share, forces, volumes, r.u, r.p, linear, report)) return false;
  for (std::size_t dof = 0; dof < unit.size(); ++dof)
    if (constrained_[dof]) r.u[dof] = unit[dof];
  r.asked = r.share * linear.right_side;
  r.left = linear.relative_residual * linear.right_side;
  return true;
}

std::vector<double> NewtonSolver::face_motions() const {
  const std::size_t n = planar_.count();
  std::vector<double> forces, volumes;
  auto right = face_forces(increment_, pressure_increment_, forces, volumes);
  for (std::size_t k = 0; k < n; ++k) right[k] = -planar_residual_[k] - right[k];
  std::vector<std::vector<double>> stiffness(n, std::vector<double>(n));
  for (std::size_t k = 0; k < n; ++k) {
    const auto column = face_forces(responses_[k].u, responses_[k].p, forces, volumes);
    for (std::size_t row = 0; row < n; ++row) stiffness[row][k] = column[row];
  }
  return solve_dense(stiffness, right);
}

/// A face moves the whole body: what is left of the response to a unit motion counts with the
/// motion, which beside a small imbalance can be large (from zero stress in a long body).
bool NewtonSolver::add_planar(double left, const std::vector<double>& x, NewtonReport& report) {
  const std::size_t n = planar_.count();
  if (n == 0) return true;
  constexpr int max_rounds = 4;
  constexpr double aim = 0.5, tightest = 1e-8, loosest = 10;
  for (std::size_t dof = 0; dof < constrained_.size(); ++dof)
    if (constrained_[dof]) increment_[dof] = 0;
  responses_.resize(n);
  std::vector<double> tolerances(n, std::min(loosest * options_.linear_tolerance, 0.1));
  bool fine = false;
  for (int round = 0; round < max_rounds && !fine; ++round) {
    for (std::size_t k = 0; k < n; ++k)
      if (!respond(k, tolerances[k], x, report)) return false;
    planar_increment_ = face_motions();
    fine = true;
    for (std::size_t k = 0; k < n; ++k) {
      const double share = left / std::abs(planar_increment_[k]);
      fine = fine && responses_[k].left <= share;
      tolerances[k] = std::clamp(aim * share / responses_[k].asked, tightest, tolerances[k]);
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Response& r = responses_[k];
    for (std::size_t i = 0; i < increment_.size(); ++i)
      increment_[i] += planar_increment_[k] * r.u[i];
    for (std::size_t e = 0; e < r.p.size(); ++e)
      pressure_increment_[e] += planar_increment_[k] * r.p[e];
  }
  return true;
}

double NewtonSolver::conjugate_residual() const {
  double work = 0;
  const auto dofs = 3 * static_cast<std::size_t>(discretisation_.local().owned_nodes);
  for (std::size_t i = 0; i < dofs; ++i)
    if (!constrained_[i]) work -= increment_[i] * residual_[i];
  work = sum(discretisation_.local().comm, work);
  for (std::size_t k = 0; k < planar_.count(); ++k)
    work -= planar_increment_[k] * planar_residual_[k];
  return work;
}

bool NewtonSolver::try_increment(const NewtonProblem& problem, double lambda,
                                 const std::vector<double>& x0, const std::vector<double>& p0,
                                 std::vector<double>& x, std::vector<double>& p,
                                 NewtonReport& report) {
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = constrained_[i] && !planar_.owns(i) ? x0[i] : x0[i] + lambda * increment_[i];
  for (std::size_t e = 0; e < p.size(); ++e) p[e] = p0[e] + lambda * pressure_increment_[e];
  const Evaluation outcome =
      discretisation_.evaluate(problem.old, x, p, problem.time_step, problem.kappa);
  if (outcome != Evaluation::fine) {
    report.reason = describe(outcome);
    return false;
  }
  update_residual(problem, x);
  report.balance = measure(x);
  return true;
}

bool NewtonSolver::search(const NewtonProblem& problem, Balance before, std::vector<double>& x,
                          std::vector<double>& p, NewtonReport& report) {
  constexpr int max_trials = 6;
  // Where a point's rate falls, Newton's method overshoots and would go to and fro with the work of
  // the residual on the increment changing sign: a fall of the residual's norm alone is no progress
  // unless it is a large one.
  constexpr double accepted_work = 0.5, accepted_norm = 0.25;
  // After the last trial the best one serves if it is progress at all.
  constexpr double useful_work = 0.9;
  const std::vector<double> x0 = x, p0 = p;
  const double work0 = conjugate_residual();
  double low = 0, work_low = work0, high = 1, work_high = 0;  // of the root of the work
  double lambda = 1, best_lambda = 0, best_work = useful_work * std::abs(work0);
  for (int trial = 0; trial < max_trials; ++trial) {
    if (trial == 1) ++report.line_searches;
    if (!try_increment(problem, lambda, x0, p0, x, p, report)) {
      lambda *= 0.5;
      continue;
    }
    const double work = conjugate_residual();
    // Of balanced forces the work is round-off: what is left to do then is in the volumes.
    if (balanced(report.balance) || report.balance.free_norm <= accepted_norm * before.free_norm ||
        std::abs(work) <= accepted_work * std::abs(work0))
      return true;
    if (std::abs(work) < best_work) {
      best_work = std::abs(work);
      best_lambda = lambda;
    }
    report.reason = "the residual does not fall along the increment";
    // Secant on the work inside its bracket [low, high], once there is one.
    if (work < 0) {
      high = lambda;
      work_high = work;
    } else {
      low = lambda;
      work_low = work;
    }
    const bool bracketed = work_low > 0 && work_high < 0;
    const double secant = bracketed ? work_low / (work_low - work_high) : 0;
    lambda = bracketed ? low + std::clamp(secant, 0.1, 0.9) * (high - low) : 0.5 * lambda;
  }
  return best_lambda > 0 && try_increment(problem, best_lambda, x0, p0, x, p, report);
}

}  // namespace polyslip::solver
