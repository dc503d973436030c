#include "drivers/run.hpp"

#include <filesystem>
#include <memory>
#include <optional>

#include "core/deck.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "core/version.hpp"
#include "drivers/deck_record.hpp"
#include "drivers/generate.hpp"
#include "drivers/mesh_files.hpp"
#include "drivers/on_root.hpp"
#include "drivers/options.hpp"
#include "drivers/run_progress.hpp"
#include "drivers/run_report.hpp"
#include "drivers/schedule.hpp"
#include "remap/remesh.hpp"
#include "results/checkpoint.hpp"
#include "results/folder.hpp"
#include "results/macro_csv.hpp"
#include "results/names.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"
#include "solver/load_program.hpp"
#include "solver/model.hpp"
#include "solver/snapshot_fields.hpp"

namespace polyslip::drivers {
namespace {

const std::string progress_key = "progress";
const std::string deck_text_key = "deck";

/// rank 0's text on every rank
void broadcast(MPI_Comm comm, std::string& text) {
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm);
}

class Run {
 public:
  Run(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool);
  int go();

 private:
  bool root() const { return rank_ == 0; }
  std::string path(std::string_view name) const {
    return results::in_folder(request_.folder, name);
  }

  void read_deck();
  void require_own_deck(const mesh::Snapshot& checkpoint, const std::string& file) const;
  mesh::Snapshot begin();
  mesh::Snapshot begin_anew();
  mesh::Snapshot take_up(const results::CheckpointFile& file);
  void build_model(const mesh::Snapshot& snapshot);
  void deform();
  void step(double target);
  void reach(const Event& event);
  void store(const mesh::Snapshot& snapshot);
  void write_checkpoint(mesh::Snapshot& snapshot);
  void remesh(const mesh::Snapshot& old);
  bool remeshing_is_due(const Event& event) const;
  void stop(const std::string& reason);
  void finish(bool completed);

  MPI_Comm comm_;
  int rank_ = 0;
  RunRequest request_;
  mesh::MesherPool& pool_;
  core::Log log_;
  core::StageTimes times_;
  double wall_start_ = core::wall_seconds();
  double strain_start_ = 0;
  std::string deck_text_, resolved_, fingerprint_;
  Options options_;
  Input input_;  ///< of a run that begins; on rank 0
  std::vector<Event> events_;
  std::unique_ptr<material::CrystalLaw> law_;
  std::unique_ptr<solver::Model> model_;
  std::optional<results::MacroCsv> macro_;
  std::optional<results::StateSeries> states_;
  RunProgress progress_;
  int mesh_number_ = 0;
};

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

Run::Run(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool)
    : comm_(comm),
      rank_(rank_of(comm)),
      request_(request),
      pool_(pool),
      log_(rank_ == 0 ? core::Log() : core::Log::silent()) {}

/// A restart reads the deck as it was understood, whose paths are absolute.
void Run::read_deck() {
  std::string file = request_.restart ? path(results::resolved_deck_name) : request_.deck;
  std::string text;
  const auto understand = [&] {
    core::Deck deck = core::Deck::from_text(text, file);
    options_ = read_options(deck, Purpose::run);
    options_.mesh.jobs = request_.jobs;
    resolved_ = deck.resolved();
    fingerprint_ = deck.fingerprint();
  };
  on_root(comm_, [&] {
    if (request_.restart && !std::filesystem::exists(file))
      throw core::InputError(file +
                             ": no such file, so there is no run to go on with; start one "
                             "with polyslip run DECK.toml --out " +
                             request_.folder);
    text = core::read_text(file);
    understand();
    if (!request_.restart) input_ = read_input(options_);
    require_box(options_, input_);
    deck_text_ = request_.restart ? core::read_text(path(results::deck_name)) : text;
  });
  broadcast(comm_, text);
  if (!root()) understand();
  law_ = material::make_fcc_law(options_.material);
  events_ = schedule(options_.output.at_strains, options_.remeshing.at_strains,
                     options_.output.checkpoint_every_strain,
                     solver::LoadProgram(options_.loading).planned_end());
}

void Run::require_own_deck(const mesh::Snapshot& checkpoint, const std::string& file) const {
  results::require_same_deck(checkpoint, file, fingerprint_);
  const auto text = checkpoint.provenance.find(deck_text_key);
  if (text == checkpoint.provenance.end() || text->second != deck_text_)
    throw core::InputError(path(results::deck_name) + ": not the deck that " + file +
                           " was computed with; put the run's own deck back, or start a new run");
}

mesh::Snapshot Run::begin_anew() {
  if (request_.restart) {
    require_unedited_deck(request_.folder);
    input_ = read_input(options_);
    require_box(options_, input_);
  }
  results::prepare_run_folder(request_.folder, request_.overwrite || request_.restart,
                              request_.restart);
  if (!request_.restart) write_decks(request_.folder, deck_text_, resolved_);
  log_.to_file(path(results::log_name));
  log_.info("polyslip {}: {}", core::version(), request_.folder);
  if (request_.restart) log_.warning("{}: no checkpoint yet; starting over", request_.folder);
  mesh::Mesh mesh = generate_polycrystal(options_, input_, request_.folder, pool_, log_, times_);
  progress_.elements_initial = mesh.element_count();
  macro_ = results::MacroCsv::create(path(results::macro_name));
  states_.emplace(request_.folder);
  return solver::initial_snapshot(std::move(mesh), input_.orientations, *law_);
}

mesh::Snapshot Run::take_up(const results::CheckpointFile& file) {
  mesh::Snapshot snapshot = results::read_checkpoint(file.path);
  require_own_deck(snapshot, file.path);
  progress_ = RunProgress::from_text(snapshot.provenance.at(progress_key));
  mesh_number_ = snapshot.mesh_number;
  states_.emplace(request_.folder);
  states_->require_first(static_cast<std::size_t>(progress_.states));
  macro_ = results::MacroCsv::resume(path(results::macro_name), progress_.rows);
  states_->keep_first(static_cast<std::size_t>(progress_.states));
  log_.to_file(path(results::log_name));
  log_.info("polyslip {}: {}: going on from strain {:.6g} ({})", core::version(), request_.folder,
            snapshot.strain, file.path);
  return snapshot;
}

/// On rank 0; the other ranks get an empty snapshot.
mesh::Snapshot Run::begin() {
  mesh::Snapshot snapshot;
  on_root(comm_, [&] {
    if (!request_.restart) {
      snapshot = begin_anew();
      return;
    }
    core::require_writable_folder(request_.folder);
    const auto file = results::newest_valid_checkpoint(request_.folder);
    snapshot = file ? take_up(*file) : begin_anew();
  });
  MPI_Bcast(&mesh_number_, 1, MPI_INT, 0, comm_);
  return snapshot;
}

void Run::build_model(const mesh::Snapshot& snapshot) {
  model_ =
      std::make_unique<solver::Model>(comm_, snapshot, *law_, options_.loading, options_.solver,
                                      [this](const std::string& line) { log_.info(line); });
}

void Run::store(const mesh::Snapshot& snapshot) {
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    states_->store(snapshot);
    ++progress_.states;
  });
}

void Run::write_checkpoint(mesh::Snapshot& snapshot) {
  model_->drop_setup();
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    macro_->sync();
    ++progress_.checkpoints;
    RunProgress stored = progress_;
    stored.cpu_s = total_times(progress_.cpu_s, times_);
    stored.wall_s += core::wall_seconds() - wall_start_;
    snapshot.provenance[results::deck_hash_key] = fingerprint_;
    snapshot.provenance[deck_text_key] = deck_text_;
    snapshot.provenance["version"] = core::version();
    snapshot.provenance["seed"] = std::to_string(options_.polycrystal.seed);
    snapshot.provenance[progress_key] = stored.text();
    results::write_checkpoint(request_.folder, progress_.checkpoints, snapshot);
  });
}

bool Run::remeshing_is_due(const Event& event) const {
  if (!event.remesh) return false;
  int due = 0;
  for (double strain : options_.remeshing.at_strains) due += strain <= event.strain + same_strain;
  return mesh_number_ < due;
}

void Run::remesh(const mesh::Snapshot& old) {
  mesh::Snapshot fresh;
  on_root(comm_, [&] {
    const auto measure = times_.measure("remeshing");
    const double workers = pool_.cpu_seconds();
    remap::RemeshReport report;
    fresh = remap::remesh(old, options_.mesh, options_.remeshing, pool_, report,
                          [this](const std::string& line) { log_.warning(line); });
    const auto load = old.history.find(solver::field::load_program);
    if (load != old.history.end()) fresh.history.insert(*load);
    times_.add("remeshing", pool_.cpu_seconds() - workers);
    write_mesh_files(fresh.mesh, request_.folder, fresh.mesh_number, options_.output.mesh_formats);
    log_.info(remeshing_text(report));
    progress_.remeshings.push_back(remeshing_summary(report));
    progress_.reload.start(old.strain, von_mises(progress_.stress));
  });
  progress_.just_remeshed = true;
  ++mesh_number_;
  build_model(fresh);
  mesh::Snapshot snapshot = model_->snapshot();
  store(snapshot);
  write_checkpoint(snapshot);
}

void Run::step(double target) {
  const bool after_remeshing = progress_.just_remeshed;
  const auto record = [&] {
    const auto measure = times_.measure("deformation");
    return model_->step(target);
  }();
  progress_.add(record);
  on_root(comm_, [&] {
    macro_->append({record.strain, record.time, record.step_size, record.stress, record.fx_x1,
                    record.fy_y1, record.fz_z1, record.newton_iterations, record.linear_iterations,
                    after_remeshing, record.load_strain, record.load_stress, record.face_forces});
    const double left = solver::LoadProgram(options_.loading).planned_end() - record.strain;
    const double pace = (core::wall_seconds() - wall_start_) / (record.strain - strain_start_);
    log_.info(step_text(record, pace * left));
  });
}

void Run::reach(const Event& event) {
  if (!event.store && !event.checkpoint && !event.remesh) return;
  mesh::Snapshot snapshot = model_->snapshot();
  if (event.store) store(snapshot);
  if (event.checkpoint) write_checkpoint(snapshot);
  if (remeshing_is_due(event)) remesh(snapshot);
}

void Run::deform() {
  strain_start_ = model_->strain();
  while (!model_->finished()) {
    const Event* next = next_event(events_, model_->strain());
    step(next ? next->strain : core::unbounded);
    const Event* here = event_at(events_, model_->strain());
    // A target of stress may end the load before its last event.
    const Event end{model_->strain(), true, true, false, true};
    if (model_->finished())
      reach(here && here->final ? *here : end);
    else if (here)
      reach(*here);
  }
}

void Run::finish(bool completed) {
  if (!model_) return;
  const mesh::Snapshot last = model_->snapshot();
  const auto cpu_s = sum_over_ranks(comm_, progress_.cpu_s, times_);
  const double memory = sum_over_ranks(comm_, core::peak_rss_mb());
  on_root(comm_, [&] {
    results::Summary summary = summarise(progress_, options_, last);
    summary.completed = completed;
    summary.cpu_s = {cpu_s.begin(), cpu_s.end()};
    summary.wall_s = progress_.wall_s + core::wall_seconds() - wall_start_;
    summary.peak_rss_mb = memory;
    results::write_summary(path(results::summary_name), summary);
    if (completed) report_end(request_.folder, *states_, summary, log_);
    if (options_.output.report) make_report(request_.folder, log_);
  });
}

/// Leaves a restartable state and says why.
void Run::stop(const std::string& reason) {
  log_.error(reason);
  if (model_) {
    mesh::Snapshot snapshot = model_->snapshot();
    write_checkpoint(snapshot);
    finish(false);
  }
  log_.error(fmt::format("{}: stopped; the last checkpoint is whole (polyslip run --restart {})",
                         request_.folder, request_.folder));
}

int Run::go() {
  read_deck();
  if (!request_.restart)
    on_root(comm_, [&] {
      results::check_run_folder(request_.folder, request_.overwrite);
      results::check_deck_place(request_.folder, deck_text_, request_.overwrite);
    });
  try {
    const mesh::Snapshot snapshot = begin();
    build_model(snapshot);
    if (mesh_number_ == 0 && model_->strain() == 0) store(model_->snapshot());
    if (const Event* here = event_at(events_, model_->strain()); here && remeshing_is_due(*here))
      remesh(snapshot);
    deform();
    finish(true);
  } catch (const core::RecoverableError& e) {
    stop(e.what());
    return exit_stopped;
  }
  return exit_fine;
}

}  // namespace

int run(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool) {
  return Run(comm, request, pool).go();
}

}  // namespace polyslip::drivers
