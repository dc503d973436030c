// When a run remeshes, and what it does if that fails.

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "drivers/mesh_files.hpp"
#include "drivers/on_root.hpp"
#include "drivers/run_job.hpp"
#include "drivers/run_report.hpp"
#include "solver/snapshot_fields.hpp"

namespace polyslip::drivers {

void RunJob::watch(const mesh::Snapshot& snapshot) {
  on_root(comm_, [&] {
    int ranks = 1;
    MPI_Comm_size(comm_, &ranks);
    // The other ranks wait, and keep their processors busy.
    if (!watch_)
      watch_.emplace(options_.remeshing, ranks > 1 ? 1 : core::thread_count(request_.jobs));
    watch_->watch(snapshot);
  });
}

remap::Wear RunJob::wear() {
  const auto positions = model_->positions();
  const auto rates = model_->departure_rates();
  remap::Wear wear;
  on_root(comm_, [&] { wear = watch_->measure(positions, rates); });
  return wear;
}

void RunJob::measure_new_mesh() {
  progress_.fresh = wear();
  progress_.fresh.inversion_strain = 0;
}

std::string RunJob::worn_elements() {
  const auto& options = options_.remeshing;
  if (!options.automatic || model_->strain() < progress_.watch_from) return {};
  const remap::Wear now = wear();
  std::string reason;
  if (root()) reason = remap::worn(progress_.fresh, now, options.wear).value_or("");
  broadcast(comm_, reason);
  return reason;
}

bool RunJob::remesh(const mesh::Snapshot& old) {
  log_.info("strain {:.6g}: remeshing ({}: {})", model_->strain(), progress_.due.trigger,
            progress_.due.reason);
  progress_.last_attempt = model_->strain();
  const RunProgress before = progress_;
  std::string reason;
  int number = 0;
  for (const RemeshingAttempt& attempt : remeshing_attempts(options_)) {
    try {
      try_remeshing(attempt, ++number, old);
      return true;
    } catch (const core::RecoverableError& error) {
      reason = error.what();
      progress_ = before;
      log_.warning("remeshing, {}: {}", attempt.what, reason);
    }
  }
  keep_old_mesh(old, reason);
  return false;
}

/// The new mesh counts from its first step on; a RecoverableError before leaves no trace in the
/// folder.
void RunJob::try_remeshing(const RemeshingAttempt& attempt, int number, const mesh::Snapshot& old) {
  remap::RemeshReport report;
  build_model(new_mesh(attempt, old, report));
  measure_new_mesh();
  const mesh::Snapshot start = model_->snapshot();
  const auto first = [&] {
    const auto measure = times_.measure("deformation");
    return model_->step(next_target());
  }();
  log_.info(remeshing_text(report));
  store(start);  // the other side of the same strain
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    write_mesh_files(start.mesh, request_.folder, start.mesh_number, options_.output.mesh_formats);
    results::RemeshingSummary summary = remeshing_summary(report);
    summary.trigger = progress_.due.trigger;
    summary.reason = progress_.due.reason;
    summary.attempts = number;
    progress_.remeshings.push_back(summary);
    progress_.reload.start(report.strain, von_mises(progress_.stress));
  });
  progress_.due = {};
  progress_.just_remeshed = true;
  progress_.watch_from = progress_.last_attempt + options_.remeshing.min_interval;
  record(first);
  mesh::Snapshot snapshot = model_->snapshot();
  write_checkpoint(snapshot);
}

/// On rank 0. An invalid mesh is a failed attempt like another.
mesh::Snapshot RunJob::new_mesh(const RemeshingAttempt& attempt, const mesh::Snapshot& old,
                                remap::RemeshReport& report) {
  mesh::Snapshot fresh;
  on_root(comm_, [&] {
    const auto measure = times_.measure("remeshing");
    const double workers = pool_.cpu_seconds();
    try {
      fresh = remap::remesh(old, attempt.meshing, attempt.remeshing, pool_, report,
                            [this](const std::string& line) { log_.warning(line); });
    } catch (const core::InternalError& error) {
      throw core::RecoverableError(error.what());
    }
    const auto load = old.history.find(solver::field::load_program);
    if (load != old.history.end()) fresh.history.insert(*load);
    times_.add("remeshing", pool_.cpu_seconds() - workers);
  });
  return fresh;
}

void RunJob::keep_old_mesh(const mesh::Snapshot& old, const std::string& reason) {
  build_model(old);
  const bool served = progress_.due.trigger != failed_step;
  progress_.failed_remeshings.push_back({model_->strain(), reason});
  progress_.due = {};
  progress_.watch_from = model_->strain() + options_.remeshing.min_interval;
  if (!served)
    throw core::RecoverableError(fmt::format(
        "strain {:.6g}: no step converges on the old mesh, and no new one could be made; last "
        "failure: {}",
        model_->strain(), reason));
  log_.warning("strain {:.6g}: going on with the old mesh", model_->strain());
}

}  // namespace polyslip::drivers
