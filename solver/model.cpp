#include "solver/model.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "solver/body_state.hpp"
#include "solver/discretisation.hpp"
#include "solver/exchange.hpp"
#include "solver/load_program.hpp"
#include "solver/newton.hpp"
#include "solver/partition.hpp"
#include "solver/predictor.hpp"
#include "solver/snapshot_fields.hpp"
#include "solver/step_control.hpp"
#include "solver/stress_search.hpp"

namespace polyslip::solver {
namespace {

using mesh::Location;

/// The stored partition if it was made for this number of ranks, else a new one. On rank 0.
std::vector<int> element_ranks(const mesh::Snapshot& snapshot, int ranks) {
  const auto stored = values_of(snapshot, field::partition, Location::element);
  const auto made_for = snapshot.history.find(field::partition_ranks);
  if (!stored.empty() && made_for != snapshot.history.end() && made_for->second.size() == 1 &&
      made_for->second[0] == ranks) {
    return {stored.begin(), stored.end()};
  }
  return partition_elements(snapshot.mesh, ranks);
}

/// [n][3] as vectors.
std::vector<core::Vec3> vectors(const std::vector<double>& values) {
  std::vector<core::Vec3> out;
  out.reserve(values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    out.emplace_back(values[i], values[i + 1], values[i + 2]);
  return out;
}

core::Vec3 box_size(MPI_Comm comm, const mesh::Snapshot& snapshot) {
  core::Vec3 size;
  for (int i = 0; i < 3; ++i) size[i] = broadcast(comm, snapshot.mesh.size[i]);
  return size;
}

}  // namespace

struct Model::Impl {
  MPI_Comm comm;
  const material::CrystalLaw& law;
  LoadingOptions loading;
  Boundary boundary;
  std::function<void(const std::string&)> log;
  bool root, mixed;
  const PointRule& rule;
  Profile* profile;
  mesh::Snapshot base;     // rank 0: mesh and what else came with the snapshot
  std::vector<int> ranks;  // rank 0: of each element
  Distribution distribution;
  NodeExchange exchange;
  BodyState body;
  Configuration& now = body.now;
  double strain = 0, time = 0;  // path of the load
  LoadProgram program;
  StepControl control;
  Predictor predictor;
  std::unique_ptr<Discretisation> discretisation;
  std::unique_ptr<NewtonSolver> newton;

  Impl(MPI_Comm c, mesh::Snapshot snapshot, const material::CrystalLaw& l, Boundary b,
       const LoadingOptions& load, const SolverOptions& options,
       std::function<void(const std::string&)> log_line, Profile* times)
      : comm(c),
        law(l),
        loading(load),
        boundary(std::move(b)),
        log(std::move(log_line)),
        root(rank_of(c) == 0),
        mixed(options.element == "mixed"),
        rule(point_rule(options.quadrature_points, options.element == "displacement-straight")),
        profile(times),
        base(checked(std::move(snapshot))),
        ranks(root ? element_ranks(base, size_of(c)) : std::vector<int>{}),
        distribution(c, base.mesh, ranks),
        exchange(distribution.local(), profile),
        program(load),
        control(load),
        predictor(3 * distribution.local().node_global.size(),
                  distribution.local().elements.size()) {
    if (!mixed && !rule.straight && options.element != "displacement")
      throw core::InternalError("Model: no element \"" + options.element + "\"");
    strain = broadcast(comm, base.strain);
    time = broadcast(comm, base.time);
    body = read_body(distribution, base, layout());
    restore_history();
    discretisation =
        std::make_unique<Discretisation>(distribution.local(), exchange, law, mixed, rule, now.x,
                                         read(field::reference_volume, Location::element, 1));
    if (body.volumes.empty()) body.volumes = discretisation->reference_volumes();
    newton = std::make_unique<NewtonSolver>(*discretisation, boundary, options, now.x);
    release_fields();
  }

  /// The snapshot on rank 0, after a check that every rank hears of.
  mesh::Snapshot checked(mesh::Snapshot snapshot) const {
    on_root(comm, [&] { check_fields(snapshot, law, rule.points); });
    return root ? std::move(snapshot) : mesh::Snapshot{};
  }

  /// Drops the fields that the ranks have now, each its part, and that `snapshot` gathers again.
  void release_fields() {
    std::erase_if(base.fields, [&](const mesh::Field& f) { return is_of_model(f, law); });
  }

  BodyLayout layout() const { return {law, rule, mixed}; }

  std::vector<double> read(const std::string& name, Location location, int components) const {
    return scatter_field(distribution, base, name, location, components);
  }

  /// A history of `count` numbers on every rank; empty if there is none.
  std::vector<double> read_history(const std::string& name, std::size_t count) const {
    std::vector<double> values;
    on_root(comm, [&] {
      const auto stored = base.history.find(name);
      if (stored == base.history.end()) return;
      values = stored->second;
      if (values.size() != count)
        throw core::InternalError("Model: the stored history \"" + name + "\" is damaged");
    });
    const bool found = broadcast(comm, !values.empty());
    if (!found) return {};
    values.resize(count);
    for (double& v : values) v = broadcast(comm, v);
    return values;
  }

  /// Without a history (no such step yet, or a file without it) the load went as planned.
  void restore_program() {
    const auto stored = read_history(field::load_program, 4);
    if (!stored.empty()) {
      program.restore(stored);
      return;
    }
    while (strain > 0 && program.advance(strain, false)) {
    }
  }

  void restore_history() {
    restore_program();
    const auto size = read_history(field::step_history, 1);
    if (!size.empty()) control.restore(size);
    const auto steps = read_history(field::predictor_steps, 2);
    if (steps.empty()) return;
    predictor.restore(read(field::rate, Location::node, 3),
                      read(field::previous_rate, Location::node, 3),
                      read(field::pressure_rate, Location::element, 1), steps[0], steps[1]);
  }

  /// Positions of the homogeneous motion from the current path to `end`.
  std::vector<double> homogeneous(double end) const {
    const core::Mat3 F = boundary.mean_gradient(program.strain(end)) *
                         boundary.mean_gradient(program.strain(strain)).inverse();
    std::vector<double> x(now.x.size());
    for (std::size_t n = 0; n < x.size(); n += 3) {
      const core::Vec3 moved = F * core::Vec3(now.x[n], now.x[n + 1], now.x[n + 2]);
      for (std::size_t i = 0; i < 3; ++i) x[n + i] = moved[static_cast<Eigen::Index>(i)];
    }
    return x;
  }

  /// x, p: homogeneous motion plus the expected departure from it; prescribed dofs exact.
  void predict(double end, std::vector<double>& x, std::vector<double>& p) const {
    x = homogeneous(end);
    p = now.p;
    predictor.extrapolate(end - strain, x, p);
    const auto& local = distribution.local();
    newton->planar().flatten(x);
    const double load_strain = program.strain(end);
    for (std::size_t dof = 0; dof < x.size(); ++dof) {
      const std::size_t n = dof / 3;
      if (!newton->constrained()[dof] || newton->planar().owns(dof)) continue;
      const core::Vec3 initial(now.x[3 * n] - body.displacement[3 * n],
                               now.x[3 * n + 1] - body.displacement[3 * n + 1],
                               now.x[3 * n + 2] - body.displacement[3 * n + 2]);
      x[dof] =
          boundary.position(local.node_faces[n], static_cast<int>(dof % 3), initial, load_strain);
    }
  }

  void accept(const std::vector<double>& x, const std::vector<double>& p, double end,
              bool stress_met) {
    const double increment = end - strain;
    auto departure = homogeneous(end);
    std::vector<double> change(p.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      departure[i] = x[i] - departure[i];
      body.displacement[i] += x[i] - now.x[i];
    }
    for (std::size_t e = 0; e < p.size(); ++e) change[e] = p[e] - now.p[e];
    predictor.record(departure, change, increment);
    discretisation->accept(x, p, now);
    body.element_stress = discretisation->element_stress();
    body.point_stress = discretisation->cauchy_stress();
    body.volumes = discretisation->volumes();
    time = program.time(end);
    strain = end;
    control.accepted(increment);
    if (!program.advance(end, stress_met)) return;
    begin_stage();
    skip_met_stages();
  }

  /// Another rate or direction: steps start small again, and the last ones foretell nothing.
  void begin_stage() {
    time = program.time(strain);
    if (program.finished()) return;
    control = StepControl(loading);
    predictor = Predictor(body.displacement.size(), now.p.size());
    say(fmt::format("strain {:.6g}: stage {} of the load begins", strain, program.stage() + 1));
  }

  /// Of the body's mean stress after the last step; 0 without one. Collective.
  double von_mises_stress() const { return von_mises(mean_stress()); }

  /// Of the body after the last step; zeros without one. Collective.
  std::array<double, 6> mean_stress() const {
    std::array<double, 7> sums{};
    for (std::size_t e = 0; e < body.volumes.size(); ++e) {
      for (std::size_t c = 0; c < 6; ++c)
        sums[c] += body.volumes[e] * body.element_stress[6 * e + c];
      sums[6] += body.volumes[e];
    }
    sum(comm, sums.data(), 7);
    std::array<double, 6> mean{};
    for (std::size_t c = 0; c < 6 && sums[6] > 0; ++c) mean[c] = sums[c] / sums[6];
    return mean;
  }

  StepRecord record(double increment, const StepRecord& counters) const {
    StepRecord r = counters;
    r.strain = strain;
    r.time = time;
    r.step_size = increment;
    r.stress = discretisation->mean_stress();
    r.load_strain = program.strain(strain);
    r.load_stress = load_stress(loading, r.stress);
    r.face_forces = face_forces(distribution.local(), boundary, discretisation->forces());
    r.fx_x1 = r.face_forces[1][0];
    r.fy_y1 = r.face_forces[3][1];
    r.fz_z1 = r.face_forces[5][2];
    r.min_jacobian_ratio = discretisation->min_jacobian_ratio();
    return r;
  }

  void say(const std::string& line) const {
    if (root && log) log(line);
  }

  /// Solves a step to `end`; x and p are then the solution, unless the report says why not.
  NewtonReport solve(double end, std::vector<double>& x, std::vector<double>& p) {
    predict(end, x, p);
    const double increment = end - strain;
    const double kappa = point_volume_modulus(von_mises_stress(), increment, law.shear_modulus());
    const NewtonProblem problem{now, program.time(end) - time, increment, kappa, end, {}};
    return newton->solve(problem, x, p);
  }

  void relax() {
    // Strain that the load would do in that time; flow in it changes stresses by about
    // shear modulus x strain, less than a hundredth of the flow stress.
    constexpr double idle = 1e-6;
    std::vector<double> x = now.x, p = now.p;
    const double scale = loading.initial_strain_increment;
    const double kappa = point_volume_modulus(von_mises_stress(), scale, law.shear_modulus());
    const NewtonProblem problem{
        now, program.time(strain + idle) - program.time(strain), scale, kappa, strain, {}};
    const NewtonReport report = newton->solve(problem, x, p);
    if (!report.converged)
      throw core::RecoverableError(fmt::format(
          "strain {:.6g}: carried stresses do not come to equilibrium: {}", strain, report.reason));
    for (std::size_t i = 0; i < x.size(); ++i) body.displacement[i] += x[i] - now.x[i];
    discretisation->accept(x, p, now);
    body.element_stress = discretisation->element_stress();
    body.point_stress = discretisation->cauchy_stress();
    body.volumes = discretisation->volumes();
  }

  /// A stage whose target of stress is met already ends where it begins.
  void skip_met_stages() {
    const double stress = load_stress(loading, mean_stress());
    while (const auto wanted = program.stress_target()) {
      if (program.direction() * (stress - *wanted) < 0) return;
      program.advance(strain, true);
      begin_stage();
    }
  }

  StepRecord step(double target, int max_cuts) {
    const Stage stage(profile, "step");
    if (!(target > strain) || program.finished())
      throw core::InternalError(fmt::format("Model::step: {} is not beyond {}", target, strain));
    target = std::min(target, program.stage_end());
    StepRecord counters;
    StressSearch search(program, load_stress(loading, mean_stress()));
    for (;;) {
      const double end =
          search.active() ? strain + search.increment() : control.next_end(strain, target);
      const double increment = end - strain;
      std::vector<double> x, p;
      const NewtonReport report = solve(end, x, p);
      counters.newton_iterations += report.iterations;
      counters.linear_iterations += report.linear_iterations;
      if (report.converged) {
        if (search.goes_on(increment, load_stress(loading, discretisation->mean_stress())))
          continue;
        accept(x, p, end, search.met());
        return record(increment, counters);
      }
      ++counters.cuts;
      search.drop();
      const bool go_on = control.cut(increment);
      say(fmt::format("strain {:.6g}: step of {:.3g} cut: {}", strain, increment, report.reason));
      if (!go_on)
        throw StepFailure(
            fmt::format("strain {:.6g}: the step fell below min_strain_increment = {:g}; last "
                        "failure: {}",
                        strain, loading.min_strain_increment, report.reason),
            counters);
      if (counters.cuts > max_cuts)
        throw StepFailure(
            fmt::format("strain {:.6g}: no step converged, down to {:.3g}; last failure: {}",
                        strain, increment, report.reason),
            counters);
    }
  }

  MeshPart part() const {
    const LocalMesh& local = distribution.local();
    MeshPart part{local.elements,
                  static_cast<std::size_t>(local.owned_nodes),
                  {},
                  vectors(now.x),
                  vectors(predictor.rate())};
    part.initial = part.positions;
    const auto u = vectors(body.displacement);
    for (std::size_t n = 0; n < u.size(); ++n) part.initial[n] -= u[n];
    return part;
  }

  std::vector<FieldPart> fields() const {
    return body_fields(body, layout(), distribution.local(), discretisation->reference_volumes(),
                       predictor);
  }

  /// The snapshot on rank 0, but for the values of these fields.
  mesh::Snapshot outline(const std::vector<FieldPart>& parts) const {
    auto x = vectors(distribution.gather_nodes(now.x, 3));
    mesh::Snapshot out = base;
    if (!root) return out;
    out.mesh.nodes = std::move(x);
    out.strain = strain;
    out.time = time;
    out.history[field::step_history] = control.history();
    out.history[field::load_program] = program.history();
    out.history[field::predictor_steps] = predictor.steps();
    out.history[field::partition_ranks] = {static_cast<double>(size_of(comm))};
    for (const FieldPart& part : parts) put(out, part.outline);
    return out;
  }

  mesh::Snapshot snapshot() const {
    const Stage stage(profile, "snapshot");
    const auto parts = fields();
    mesh::Snapshot out = outline(parts);
    fill_fields(distribution, parts, out);
    return out;
  }

  void show(const SnapshotUse& use) const {
    const Stage stage(profile, "snapshot");
    const auto parts = fields();
    mesh::Snapshot out = outline(parts);
    serve_fields(distribution, parts, out,
                 [&](const mesh::FieldReader& fields_of) { use(out, fields_of); });
  }
};

namespace {

LoadingOptions without_end(LoadingOptions loading) {
  constexpr double far = 1e6;
  if (loading.stages.empty()) loading.final_strain = far;
  return loading;
}

}  // namespace

Model::Model(MPI_Comm comm, mesh::Snapshot snapshot, const material::CrystalLaw& law,
             const LoadingOptions& loading, const SolverOptions& options,
             std::function<void(const std::string&)> log, Profile* profile) {
  Boundary boundary = make_boundary(loading, box_size(comm, snapshot));
  impl_ = std::make_unique<Impl>(comm, std::move(snapshot), law, std::move(boundary), loading,
                                 options, std::move(log), profile);
}

Model::Model(MPI_Comm comm, mesh::Snapshot snapshot, const material::CrystalLaw& law,
             Boundary boundary, const LoadingOptions& loading, const SolverOptions& options,
             std::function<void(const std::string&)> log, Profile* profile)
    : impl_(std::make_unique<Impl>(comm, std::move(snapshot), law, std::move(boundary),
                                   without_end(loading), options, std::move(log), profile)) {}

Model::~Model() = default;
double Model::strain() const { return impl_->strain; }
double Model::time() const { return impl_->time; }
bool Model::finished() const { return impl_->program.finished(); }
StepRecord Model::step(double target_strain, int max_cuts) {
  return impl_->step(target_strain, max_cuts);
}
void Model::relax() { impl_->relax(); }
void Model::drop_setup() { impl_->newton->drop_setup(impl_->now.x); }
FlowPast Model::past_flat_faces() const {
  return farthest_past_flat_faces(impl_->distribution.local(), impl_->boundary, impl_->now.x,
                                  impl_->program.strain(impl_->strain));
}
MeshPart Model::part() const { return impl_->part(); }
mesh::Snapshot Model::snapshot() const { return impl_->snapshot(); }
void Model::show(const SnapshotUse& use) const { impl_->show(use); }

}  // namespace polyslip::solver
