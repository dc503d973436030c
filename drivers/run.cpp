#include "drivers/run.hpp"

#include <filesystem>

#include "core/deck.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"
#include "drivers/deck_record.hpp"
#include "drivers/on_root.hpp"
#include "drivers/run_job.hpp"
#include "drivers/run_report.hpp"
#include "results/folder.hpp"
#include "results/names.hpp"
#include "solver/load_program.hpp"

namespace polyslip::drivers {
namespace {

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

}  // namespace

void broadcast(MPI_Comm comm, std::string& text) {
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm);
}

RunJob::RunJob(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool)
    : comm_(comm),
      rank_(rank_of(comm)),
      request_(request),
      pool_(pool),
      log_(rank_ == 0 ? core::Log() : core::Log::silent()),
      wall_start_(core::wall_seconds()) {}

std::string RunJob::path(std::string_view name) const {
  return results::in_folder(request_.folder, name);
}

/// A restart reads the deck as it was understood, whose paths are absolute.
void RunJob::read_deck() {
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
    if (request_.restart && results::StateSeries(request_.folder).without_mesh())
      throw core::InputError(request_.folder +
                             ": holds a Taylor model, which is not restarted; run polyslip taylor "
                             "again with --overwrite");
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

void RunJob::require_own_deck(const mesh::Snapshot& checkpoint, const std::string& file) const {
  results::require_same_deck(checkpoint, file, fingerprint_);
  const auto text = checkpoint.provenance.find(deck_text_key);
  if (text == checkpoint.provenance.end() || text->second != deck_text_)
    throw core::InputError(path(results::deck_name) + ": not the deck that " + file +
                           " was computed with; put the run's own deck back, or start a new run");
}

mesh::Snapshot RunJob::begin_anew() {
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
  return solver::initial_snapshot(std::move(mesh), input_.orientations, *law_,
                                  options_.solver.quadrature_points);
}

mesh::Snapshot RunJob::take_up(const results::CheckpointFile& file) {
  mesh::Snapshot snapshot = results::read_checkpoint(file.path);
  require_own_deck(snapshot, file.path);
  progress_ = RunProgress::from_text(snapshot.provenance.at(progress_key));
  states_.emplace(request_.folder);
  states_->require_first(static_cast<std::size_t>(progress_.states));
  macro_ = results::MacroCsv::resume(path(results::macro_name), progress_.rows);
  states_->keep_first(static_cast<std::size_t>(progress_.states));
  log_.to_file(path(results::log_name));
  log_.info("polyslip {}: {}: going on from strain {:.6g} ({})", core::version(), request_.folder,
            snapshot.strain, file.path);
  snapshot.provenance.clear();  // of the checkpoint; states do not repeat it
  return snapshot;
}

/// On rank 0; the other ranks get an empty snapshot. Every rank knows how far the run is.
mesh::Snapshot RunJob::begin() {
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
  std::string progress = progress_.text();
  broadcast(comm_, progress);
  progress_ = RunProgress::from_text(progress);
  return snapshot;
}

void RunJob::build_model(mesh::Snapshot snapshot) {
  model_.reset();  // not two at a time
  model_ = std::make_unique<solver::Model>(
      comm_, std::move(snapshot), *law_, options_.loading, options_.solver,
      [this](const std::string& line) { log_.info(line); }, request_.profile ? &profile_ : nullptr);
}

void RunJob::write_profile() {
  if (!request_.profile) return;
  solver::write_petsc_log(path(results::petsc_profile_name));
  const std::string text = solver::profile_text(profile_, comm_);
  on_root(comm_, [&] {
    core::write_file(path(results::profile_name), text);
    log_.info("profile: " + path(results::profile_name));
  });
}

void RunJob::finish(bool completed) {
  if (!model_) return;
  write_profile();
  const auto cpu_s = sum_over_ranks(comm_, progress_.cpu_s, times_);
  const double memory = sum_over_ranks(comm_, core::peak_rss_mb());
  results::Summary summary;
  model_->show([&](const mesh::Snapshot& last, const mesh::FieldReader&) {
    summary = summarise(progress_, options_, last);
  });
  on_root(comm_, [&] {
    summary.completed = completed;
    summary.cpu_s = {cpu_s.begin(), cpu_s.end()};
    summary.wall_s = progress_.wall_s + core::wall_seconds() - wall_start_;
    summary.peak_rss_mb = memory;
    results::write_summary(path(results::summary_name), summary);
    if (completed) report_end(request_.folder, *states_, summary, log_);
    if (options_.output.report) make_report(request_.folder, options_.texture, log_);
  });
}

/// Leaves a restartable state and says why.
void RunJob::stop(const std::string& reason) {
  log_.error(reason);
  if (model_) {
    progress_.last_attempt = -1;  // a restart may try again to remesh here
    write_checkpoint();
    finish(false);
  }
  log_.error(fmt::format("{}: stopped; the last checkpoint is whole (polyslip run --restart {})",
                         request_.folder, request_.folder));
}

/// The model, and what a run that was killed in a remeshing has still to do.
void RunJob::start() {
  build_model(begin());
  if (model_->strain() == 0 && progress_.states == 0) {
    measure_new_mesh(core::Vec3::Ones());
    store();
  }
  last_step_ = core::wall_seconds();
  if (progress_.due) {
    log_.info("a remeshing is due: {}", progress_.due.reason);
    if (remesh(model_->snapshot())) arrive();
  }
}

int RunJob::go() {
  if (request_.profile) profile_.log_with_petsc();
  read_deck();
  if (!request_.restart)
    on_root(comm_, [&] {
      results::check_run_folder(request_.folder, request_.overwrite);
      results::check_deck_place(request_.folder, deck_text_, request_.overwrite);
    });
  try {
    start();
    deform();
    finish(true);
  } catch (const core::RecoverableError& e) {
    stop(e.what());
    return exit_stopped;
  }
  return exit_fine;
}

int run(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool) {
  return RunJob(comm, request, pool).go();
}

}  // namespace polyslip::drivers
