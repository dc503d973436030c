// The steps of a run, and what is done between them.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/version.hpp"
#include "drivers/on_root.hpp"
#include "drivers/run_job.hpp"
#include "drivers/run_report.hpp"
#include "results/names.hpp"
#include "solver/load_program.hpp"

namespace polyslip::drivers {

void RunJob::store() {
  model_->show([&](const mesh::Snapshot& outline, const mesh::FieldReader& read) {
    const auto measure = times_.measure("output");
    states_->store(outline, read);
    ++progress_.states;
    progress_.last_stored = outline.strain;
  });
  MPI_Bcast(&progress_.last_stored, 1, MPI_DOUBLE, 0, comm_);
}

void RunJob::store(const mesh::Snapshot& snapshot) {
  on_root(comm_, [&] {
    const auto measure = times_.measure("output");
    states_->store(snapshot);
    ++progress_.states;
  });
  progress_.last_stored = snapshot.strain;
  MPI_Bcast(&progress_.last_stored, 1, MPI_DOUBLE, 0, comm_);
}

bool RunJob::stored_here() const {
  return std::abs(progress_.last_stored - model_->strain()) <= same_strain;
}

void RunJob::write_checkpoint() {
  model_->drop_setup();
  model_->show([&](mesh::Snapshot& outline, const mesh::FieldReader& read) {
    const auto measure = times_.measure("output");
    macro_->sync();
    ++progress_.checkpoints;
    RunProgress stored = progress_;
    stored.cpu_s = total_times(progress_.cpu_s, times_);
    stored.wall_s += core::wall_seconds() - wall_start_;
    outline.provenance[results::deck_hash_key] = fingerprint_;
    outline.provenance[deck_text_key] = deck_text_;
    outline.provenance["version"] = core::version();
    outline.provenance["seed"] = std::to_string(options_.polycrystal.seed);
    outline.provenance[progress_key] = stored.text();
    results::write_checkpoint(request_.folder, progress_.checkpoints, outline, read);
  });
}

double RunJob::next_target() const {
  const Event* next = next_event(events_, model_->strain());
  return next ? next->strain : core::unbounded;
}

solver::StepRecord RunJob::take_step(int max_cuts) {
  const auto measure = times_.measure("deformation");
  try {
    return model_->step(next_target(), max_cuts);
  } catch (const solver::StepFailure& failure) {
    progress_.add_attempts(failure.tried);
    throw;
  }
}

void RunJob::record(const solver::StepRecord& step) {
  const bool after_remeshing = progress_.just_remeshed;
  progress_.add(step);
  on_root(comm_, [&] {
    macro_->append({step.strain, step.time, step.step_size, step.stress, step.fx_x1, step.fy_y1,
                    step.fz_z1, step.newton_iterations, step.linear_iterations, after_remeshing,
                    step.load_strain, step.load_stress, step.face_forces});
    log_.info(step_text(step, time_left(step)));
  });
}

double RunJob::time_left(const solver::StepRecord& step) {
  const double now = core::wall_seconds();
  pace_.add(now - last_step_);
  last_step_ = now;
  const double next = std::min(step.step_size * options_.loading.increment_growth,
                               options_.loading.max_strain_increment);
  const double end = solver::LoadProgram(options_.loading).planned_end();
  return pace_.mean() * steps_ahead(step.strain, next, end, events_, options_.loading);
}

void RunJob::advance() {
  // A new mesh has a step's worth of strain behind it: one made here would be the same again.
  const bool remeshable =
      options_.remeshing.automatic && model_->strain() > progress_.last_attempt + same_strain;
  const bool settled = model_->strain() >= progress_.last_attempt + options_.remeshing.min_interval;
  try {
    record(take_step(remeshable && settled ? cuts_before_a_new_mesh : solver::any_cuts));
  } catch (const core::RecoverableError& error) {
    if (!remeshable) {
      stop_on_the_old_mesh();
      throw;
    }
    progress_.due = {failed_step, error.what()};
    if (!stored_here()) store();
    write_checkpoint();
    remesh(model_->snapshot());
  }
}

void RunJob::stop_on_the_old_mesh() const {
  const auto& failed = progress_.failed_remeshings;
  if (failed.empty() || std::abs(failed.back().strain - model_->strain()) > same_strain) return;
  throw core::RecoverableError(fmt::format(
      "strain {:.6g}: no step converges on the old mesh, and no new one could be made; last "
      "failure: {}",
      model_->strain(), failed.back().reason));
}

/// A little is a matter of a few elements at an edge of the body.
void RunJob::watch_flat_faces() {
  constexpr double noticed = 0.01, allowed = 0.05;  // of the body's length
  const solver::FlowPast past = model_->past_flat_faces();
  if (past.distance <= noticed) return;
  const std::string what = fmt::format(
      "strain {:.6g}: a free face has flowed past the plane of the flat face {}, by {:.1f} % of "
      "the body's length across it",
      model_->strain(), mesh::box_face_names[static_cast<std::size_t>(past.face)],
      100 * past.distance);
  if (past.distance > allowed) {
    if (!stored_here()) store();
    throw core::RecoverableError(fmt::format(
        "{}: contact is not computed, and what follows would be wrong; end the run before, or keep "
        "the free face flat with zero mean force: {}",
        what,
        options_.loading.type == "faces" ? "\"planar\" in [loading]"
                                         : "[loading] lateral = \"planar\""));
  }
  if (!std::exchange(flow_past_said_, true))
    log_.warning("{}: contact is not computed; at {:g} % the run stops", what, 100 * allowed);
}

/// What the schedule has here; the end comes with a target of stress or time too.
Event RunJob::event_here() const {
  const Event* here = event_at(events_, model_->strain());
  Event event = here ? *here : Event{.strain = model_->strain()};
  if (model_->finished() && !event.final)
    event = {.strain = event.strain, .store = true, .checkpoint = true, .final = true};
  return event;
}

/// Whether the end, or a remeshing that the deck asks for, is so near that worn elements can wait.
bool RunJob::worn_can_wait() const {
  const double near = model_->strain() + options_.remeshing.min_interval;
  if (near > solver::LoadProgram(options_.loading).planned_end()) return true;
  for (const double strain : options_.remeshing.at_strains)
    if (strain > model_->strain() && strain < near) return true;
  return false;
}

DueRemeshing RunJob::due_here(const Event& event) {
  if (model_->finished()) return {};
  if (event.remesh && progress_.last_attempt + same_strain < event.strain)
    return {at_strains, fmt::format("the deck asks for it at strain {:g}", event.strain)};
  if (worn_can_wait()) return {};
  if (const std::string reason = worn_elements(); !reason.empty()) return {worn_out, reason};
  return {};
}

void RunJob::arrive() {
  for (;;) {
    const Event event = event_here();
    progress_.due = due_here(event);
    const bool due = static_cast<bool>(progress_.due);
    if (!event.store && !event.checkpoint && !due) return;
    if (event.store || due) store();
    if (event.checkpoint || due) write_checkpoint();
    // A remeshing ends with a step, and so at another strain.
    if (!due || !remesh(model_->snapshot())) return;
  }
}

void RunJob::deform() {
  while (!model_->finished()) {
    watch_flat_faces();
    advance();
    arrive();
  }
  watch_flat_faces();
}

}  // namespace polyslip::drivers
