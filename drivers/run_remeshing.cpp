// When a run remeshes, and what it does if that fails.

#include <array>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/parallel.hpp"
#include "drivers/mesh_files.hpp"
#include "drivers/on_root.hpp"
#include "drivers/run_job.hpp"
#include "drivers/run_report.hpp"
#include "results/names.hpp"
#include "solver/exchange.hpp"
#include "solver/snapshot_fields.hpp"

namespace polyslip::drivers {
namespace {

/// A remeshing that changed a grain beyond the deck's limits: no reason to go on without one.
class AuditFailure : public core::RecoverableError {
 public:
  using core::RecoverableError::RecoverableError;
};

/// First step with carried stresses over the last before: what was carried has to settle.
constexpr double first_step_share = 0.25;

}  // namespace

core::Mat3 RunJob::isotropy_frame(const solver::MeshPart& part) const {
  const auto owned = [&](const std::vector<core::Vec3>& values) {
    return std::span(values).first(part.owned_nodes);
  };
  return remap::isotropy_frame(
      solver::all_gather(comm_, remap::frame_moments(owned(part.initial), owned(part.positions))));
}

/// Each rank measures its own elements.
remap::Wear RunJob::wear() const {
  const solver::MeshPart part = model_->part();
  const core::Mat3 frame = progress_.sizes * isotropy_frame(part);
  const int threads = solver::size_of(comm_) > 1 ? 1 : core::thread_count(request_.jobs);
  return remap::whole_wear(
      solver::all_gather(comm_, remap::measure_part(part.elements, part.positions, part.rates,
                                                    frame, options_.remeshing.wear, threads)));
}

void RunJob::measure_new_mesh(const core::Vec3& scale) {
  const std::array<double, 3> on_root =
      solver::all_gather(comm_, std::array<double, 3>{scale[0], scale[1], scale[2]}).front();
  progress_.sizes = remap::size_frame(core::Vec3(on_root.data()), isotropy_frame(model_->part()));
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
  std::string reason, beyond_limits;
  int number = 0;
  for (const RemeshingAttempt& attempt : remeshing_attempts(options_)) {
    try {
      try_remeshing(attempt, ++number, old);
      return true;
    } catch (const core::RecoverableError& error) {
      reason = error.what();
      if (dynamic_cast<const AuditFailure*>(&error)) beyond_limits = reason;
      progress_.go_back(before);
      log_.warning("remeshing, {}: {}", attempt.what, reason);
    }
  }
  keep_old_mesh(old, beyond_limits.empty() ? reason : beyond_limits, !beyond_limits.empty());
  return false;
}

/// The new mesh counts from its first step on; a RecoverableError before leaves no trace in the
/// folder.
void RunJob::try_remeshing(const RemeshingAttempt& attempt, int number, const mesh::Snapshot& old) {
  remap::RemeshReport report;
  mesh::Snapshot fresh = new_mesh(attempt, old, report);
  std::string beyond = report.beyond_limits;
  broadcast(comm_, beyond);
  if (!beyond.empty()) throw AuditFailure(beyond);
  const core::Vec3 scale =
      root() ? remap::meshing_scale(fresh.mesh, attempt.remeshing) : core::Vec3(core::Vec3::Ones());
  build_model(std::move(fresh));
  if (attempt.remeshing.transport.stress == "carried") model_->relax();
  measure_new_mesh(scale);
  const mesh::Snapshot start = model_->snapshot();
  const solver::StepRecord first = take_step(cuts_before_a_new_mesh);
  log_.info(remeshing_text(report));
  store(start);  // the other side of the same strain
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    write_mesh_files(start.mesh, request_.folder, start.mesh_number, options_.output.mesh_formats);
    core::write_file(path(results::remeshing_name(start.mesh_number)), remeshing_table(report));
    results::RemeshingSummary summary = remeshing_summary(report);
    summary.stress_before = von_mises(progress_.stress);
    summary.trigger = progress_.due.trigger;
    summary.reason = progress_.due.reason;
    summary.attempts = number;
    progress_.remeshings.push_back(summary);
    progress_.reload.start(report.strain, summary.stress_before, progress_.slope);
  });
  progress_.due = {};
  progress_.just_remeshed = true;
  progress_.watch_from = progress_.last_attempt + options_.remeshing.min_interval;
  record(first);
  write_checkpoint();
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
    const auto step = old.history.find(solver::field::step_history);
    if (step != old.history.end() && attempt.remeshing.transport.stress == "carried")
      fresh.history[solver::field::step_history] = {step->second.at(0) * first_step_share};
    times_.add("remeshing", pool_.cpu_seconds() - workers);
  });
  return fresh;
}

void RunJob::keep_old_mesh(const mesh::Snapshot& old, const std::string& reason,
                           bool beyond_limits) {
  build_model(old);
  progress_.failed_remeshings.push_back({model_->strain(), reason});
  // It stays due: a restart must not go on without it either.
  if (beyond_limits) throw core::RecoverableError(reason);
  progress_.due = {};
  progress_.watch_from = model_->strain() + options_.remeshing.min_interval;
  log_.warning("strain {:.6g}: going on with the old mesh", model_->strain());
}

}  // namespace polyslip::drivers
