#include "drivers/taylor.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "core/deck.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/log.hpp"
#include "core/tensor.hpp"
#include "core/timer.hpp"
#include "core/version.hpp"
#include "drivers/deck_record.hpp"
#include "drivers/generate.hpp"
#include "drivers/on_root.hpp"
#include "drivers/orientations.hpp"
#include "drivers/run.hpp"
#include "drivers/run_report.hpp"
#include "drivers/schedule.hpp"
#include "drivers/taylor_model.hpp"
#include "results/folder.hpp"
#include "results/macro_csv.hpp"
#include "results/names.hpp"
#include "results/state_series.hpp"
#include "results/summary.hpp"
#include "solver/boundary.hpp"
#include "solver/load_program.hpp"
#include "solver/step_control.hpp"

namespace polyslip::drivers {
namespace {

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
constexpr double stiffening = 1e5;       // elastic moduli, so that elasticity is soon over
constexpr double probing_strain = 1e-5;  // of the second step, in which factors are read

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

/// rank 0's orientations on every rank
void broadcast(MPI_Comm comm, std::vector<core::Quaternion>& orientations) {
  int count = static_cast<int>(orientations.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, comm);
  orientations.resize(static_cast<std::size_t>(count));
  for (auto& q : orientations) MPI_Bcast(q.coeffs().data(), 4, MPI_DOUBLE, 0, comm);
}

void broadcast(MPI_Comm comm, std::string& text) {
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm);
}

std::array<double, 6> components(const core::Vec6& deviator, double mean) {
  const core::Mat3 s = core::from_mandel(deviator) + mean * core::Mat3::Identity();
  return {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1)};
}

class Taylor {
 public:
  Taylor(MPI_Comm comm, const TaylorRequest& request)
      : comm_(comm),
        root_(rank_of(comm) == 0),
        request_(request),
        log_(root_ ? core::Log() : core::Log::silent()) {}

  int go() {
    read();
    begin();
    try {
      deform();
    } catch (const core::RecoverableError& e) {
      log_.error(e.what());
      finish(false);
      return exit_stopped;
    }
    finish(true);
    return exit_fine;
  }

 private:
  void read();
  void begin();
  void deform();
  void step(double target);
  void record(double taken);
  void store();
  void finish(bool completed);
  double mean_stress(const core::Vec6& deviator) const;
  std::string path(std::string_view name) const {
    return results::in_folder(request_.folder, name);
  }

  MPI_Comm comm_;
  bool root_;
  TaylorRequest request_;
  core::Log log_;
  core::StageTimes times_;
  double wall_start_ = core::wall_seconds();
  std::string text_, resolved_;
  Options options_;
  std::vector<core::Quaternion> orientations_;
  std::function<core::Mat3(double)> gradient_;  // of the load strain
  std::unique_ptr<material::CrystalLaw> law_;
  std::optional<TaylorModel> model_;
  std::optional<solver::LoadProgram> program_;
  std::optional<solver::StepControl> control_;
  std::optional<results::MacroCsv> macro_;      // on rank 0
  std::optional<results::StateSeries> states_;  // on rank 0
  TaylorFactors factors_;
  double path_ = 0;  // of the load
  long steps_ = 0, cuts_ = 0;
  std::array<double, 6> stress_{};
};

void Taylor::read() {
  const auto understand = [&] {
    core::Deck deck = core::Deck::from_text(text_, request_.deck);
    options_ = read_options(deck, Purpose::taylor);
    resolved_ = deck.resolved();
  };
  on_root(comm_, [&] {
    text_ = core::read_text(request_.deck);
    understand();
    orientations_ = taylor_orientations(options_);
    results::check_run_folder(request_.folder, request_.overwrite);
    results::check_deck_place(request_.folder, text_, request_.overwrite);
  });
  broadcast(comm_, text_);
  if (!root_) understand();
  broadcast(comm_, orientations_);
  law_ = material::make_fcc_law(options_.material);
  gradient_ = solver::make_boundary(options_.loading, core::Vec3::Ones()).mean_gradient;
  program_.emplace(options_.loading);
  control_.emplace(options_.loading);
  model_.emplace(comm_, *law_, orientations_);
}

void Taylor::begin() {
  factors_ = initial_taylor_factors(comm_, options_, orientations_);
  on_root(comm_, [&] {
    results::prepare_run_folder(request_.folder, request_.overwrite);
    std::filesystem::remove(path(results::checkpoints_folder));  // there are none; it is empty
    write_decks(request_.folder, text_, resolved_);
    log_.to_file(path(results::log_name));
    log_.info("polyslip {}: {}: Taylor model of {} orientations", core::version(), request_.folder,
              orientations_.size());
    log_.info("initial orientations: stress {:.4f} g, slip {:.4f} per von Mises strain",
              factors_.stress, factors_.slip);
    macro_ = results::MacroCsv::create(path(results::macro_name));
    states_.emplace(request_.folder);
  });
  store();
}

double Taylor::mean_stress(const core::Vec6& deviator) const {
  double sum = 0;
  const auto axes = free_axes(options_.loading);
  for (const int axis : axes) sum += deviator[axis];
  return axes.empty() ? 0 : -sum / static_cast<double>(axes.size());
}

void Taylor::store() {
  const double mean = steps_ == 0 ? 0 : mean_stress(model_->mean_deviator());
  results::OrientationState state{program_->time(path_), path_, model_->table(mean)};
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    states_->store(state);
  });
}

void Taylor::step(double target) {
  const auto measure = times_.measure("deformation");
  while (true) {
    const double end = control_->next_end(path_, target), taken = end - path_;
    const core::Mat3 relative =
        gradient_(program_->strain(end)) * gradient_(program_->strain(path_)).inverse();
    const long failed = model_->deform(relative, program_->time(end) - program_->time(path_));
    if (failed == 0) {
      control_->accepted(taken);
      path_ = end;
      ++steps_;
      record(taken);
      return;
    }
    ++cuts_;
    if (!control_->cut(taken))
      throw core::RecoverableError(
          fmt::format("strain {:.6g}: the step fell below min_strain_increment = {:g}; {} of {} "
                      "orientations did not converge",
                      path_, options_.loading.min_strain_increment, failed, model_->size()));
  }
}

void Taylor::record(double taken) {
  const core::Vec6 deviator = model_->mean_deviator();
  stress_ = components(deviator, mean_stress(deviator));
  results::MacroRow row;
  row.strain = path_;
  row.time = program_->time(path_);
  row.step_size = taken;
  row.stress = stress_;
  row.fx_x1 = row.fy_y1 = row.fz_z1 = unset;
  for (auto& force : row.face_forces) force.fill(unset);
  row.load_strain = program_->strain(path_);
  row.load_stress = solver::load_stress(options_.loading, stress_);
  on_root(comm_, [&] {
    macro_->append(row);
    log_.info("strain {:.5f}  stress {:7.3f} MPa  step {:.2e}", path_, solver::von_mises(stress_),
              taken);
  });
}

void Taylor::deform() {
  const auto events = schedule(options_.output.at_strains, options_.remeshing.at_strains, 0,
                               program_->planned_end());
  while (!program_->finished()) {
    const Event* next = next_event(events, path_);
    step(std::min(next ? next->strain : core::unbounded, program_->stage_end()));
    const Event* here = event_at(events, path_);
    if (program_->advance(path_, false)) control_.emplace(options_.loading);
    if (here) store();
  }
}

void Taylor::finish(bool completed) {
  const auto cpu_s = sum_over_ranks(comm_, {}, times_);
  const double memory = sum_over_ranks(comm_, core::peak_rss_mb());
  on_root(comm_, [&] {
    results::Summary s;
    s.completed = completed;
    s.final_strain = path_;
    s.grains = static_cast<int>(orientations_.size());
    s.steps = steps_;
    s.step_cuts = cuts_;
    const auto& t = stress_;
    s.stress_final_mpa = {{{t[0], t[5], t[4]}, {t[5], t[1], t[3]}, {t[4], t[3], t[2]}}};
    for (const auto& [stage, seconds] : cpu_s)
      if (stage == "deformation" || stage == "output") s.cpu_s[stage] = seconds;
    s.wall_s = core::wall_seconds() - wall_start_;
    s.peak_rss_mb = memory;
    s.version = core::version();
    s.seed = options_.polycrystal.seed;
    s.taylor = {factors_.stress, factors_.slip};
    results::write_summary(path(results::summary_name), s);
    log_.info("summary: {} orientations to strain {:.4g} in {} steps; {:.1f} s of wall time",
              orientations_.size(), path_, steps_, *s.wall_s);
  });
}

}  // namespace

int taylor(MPI_Comm comm, const TaylorRequest& request) { return Taylor(comm, request).go(); }

std::vector<core::Quaternion> taylor_orientations(const Options& options) {
  if (!options.taylor.orientations) return read_input(options).orientations;
  Options many = options;
  many.polycrystal.grains = *options.taylor.orientations;
  return grain_orientations(many);
}

std::vector<int> free_axes(const solver::LoadingOptions& loading) {
  std::vector<int> axes;
  const bool plane_strain = loading.type == "plane-strain-compression";
  if (!plane_strain && !loading.type.starts_with("uniaxial")) return axes;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != loading.axis && !(plane_strain && axis == loading.constrained_axis))
      axes.push_back(axis);
  return axes;
}

TaylorFactors initial_taylor_factors(MPI_Comm comm, const Options& options,
                                     const std::vector<core::Quaternion>& orientations) {
  material::MaterialOptions rigid = options.material;
  rigid.c11 *= stiffening;
  rigid.c12 *= stiffening;
  rigid.c44 *= stiffening;
  rigid.g0 = rigid.gs = 1;
  rigid.h0 = 0;
  const auto law = material::make_fcc_law(rigid);
  const auto gradient = solver::make_boundary(options.loading, core::Vec3::Ones()).mean_gradient;
  const double h = 1e-4;  // central difference: to 1e-8
  const core::Mat3 velocity = (gradient(h) - gradient(-h)) / (2 * h);
  const core::Mat3 unit = velocity / core::equivalent_strain(core::symmetric_part(velocity));
  const core::Mat3 relative = material::exponential(unit * probing_strain);
  const double dt = probing_strain / rigid.reference_slip_rate;
  TaylorModel model(comm, *law, orientations);
  long failed = model.deform(relative, dt);
  const double before = model.mean_slip();
  failed += model.deform(relative, dt);
  if (failed != 0) throw core::RecoverableError("Taylor factors: the crystals did not converge");
  return {core::mandel(unit).dot(model.mean_deviator()),
          (model.mean_slip() - before) / probing_strain};
}

}  // namespace polyslip::drivers
