#pragma once
// One call of `polyslip run`: what it holds, and its stages. Collective but where said otherwise.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/log.hpp"
#include "core/timer.hpp"
#include "drivers/generate.hpp"
#include "drivers/options.hpp"
#include "drivers/remeshing_attempts.hpp"
#include "drivers/run.hpp"
#include "drivers/run_progress.hpp"
#include "drivers/schedule.hpp"
#include "drivers/time_left.hpp"
#include "results/checkpoint.hpp"
#include "results/macro_csv.hpp"
#include "results/state_series.hpp"
#include "solver/model.hpp"

namespace polyslip::drivers {

/// Names of what a checkpoint keeps of a run, in its snapshot's provenance.
inline const std::string progress_key = "progress", deck_text_key = "deck";

/// A step that fails at a thirtieth of its size does so at any, or is followed by others as small:
/// another mesh is tried.
inline constexpr int cuts_before_a_new_mesh = 5;

class RunJob {
 public:
  RunJob(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool);
  /// The exit code.
  int go();

 private:
  bool root() const { return rank_ == 0; }
  std::string path(std::string_view name) const;

  // run.cpp: from the deck, or a checkpoint, to the first step
  void read_deck();
  void require_own_deck(const mesh::Snapshot& checkpoint, const std::string& file) const;
  mesh::Snapshot begin();
  mesh::Snapshot begin_anew();
  mesh::Snapshot take_up(const results::CheckpointFile& file);
  void build_model(mesh::Snapshot snapshot);
  void start();

  // run.cpp: the end
  void stop(const std::string& reason);
  void finish(bool completed);
  void write_profile();

  // run_deformation.cpp
  void deform();
  /// One step, or a remeshing and a step, because none converged.
  void advance();
  /// One step; of one that fails the attempts are counted.
  solver::StepRecord take_step(int max_cuts);
  /// RecoverableError if a remeshing has failed where now no step converges.
  void stop_on_the_old_mesh() const;
  /// Warns if a free face has flowed past a flat one; if far, stores the state and throws
  /// RecoverableError.
  void watch_flat_faces();
  double next_target() const;
  /// Counts and writes a step.
  void record(const solver::StepRecord& step);
  /// At the end of a step [s]; on rank 0.
  double time_left(const solver::StepRecord& step);
  /// Stores, writes checkpoints and remeshes, as is due at this strain.
  void arrive();
  Event event_here() const;
  bool worn_can_wait() const;
  DueRemeshing due_here(const Event& event);
  /// The body as it is.
  void store();
  void store(const mesh::Snapshot& snapshot);
  bool stored_here() const;
  void write_checkpoint();

  // run_remeshing.cpp
  /// Notes what the mesh is like as it left the mesher, made in the frame of sizes scaled by
  /// `scale` (rank 0's counts).
  void measure_new_mesh(const core::Vec3& scale);
  /// Of the body; the same on every rank.
  core::Mat3 isotropy_frame(const solver::MeshPart& part) const;
  /// Of the present mesh; the same on every rank.
  remap::Wear wear() const;
  /// Why the elements are worn; empty if they are not.
  std::string worn_elements();
  /// `progress_.due`, from the state `old` (on rank 0), of which a checkpoint was written. True
  /// after a step on a new mesh; false if the run goes on from `old`, on its mesh. Throws
  /// RecoverableError, with the model as in `old`, if it cannot.
  bool remesh(const mesh::Snapshot& old);
  void try_remeshing(const RemeshingAttempt& attempt, int number, const mesh::Snapshot& old);
  mesh::Snapshot new_mesh(const RemeshingAttempt& attempt, const mesh::Snapshot& old,
                          remap::RemeshReport& report);
  void keep_old_mesh(const mesh::Snapshot& old, const std::string& reason, bool beyond_limits);

  MPI_Comm comm_;
  int rank_ = 0;
  RunRequest request_;
  mesh::MesherPool& pool_;
  core::Log log_;
  core::StageTimes times_;
  double wall_start_;
  double last_step_ = 0;  ///< wall clock [s]
  Pace pace_;             ///< on rank 0
  std::string deck_text_, resolved_, fingerprint_;
  Options options_;
  Input input_;  ///< of a run that begins; on rank 0
  std::vector<Event> events_;
  std::unique_ptr<material::CrystalLaw> law_;
  solver::Profile profile_;
  std::unique_ptr<solver::Model> model_;
  std::optional<results::MacroCsv> macro_;
  std::optional<results::StateSeries> states_;
  RunProgress progress_;
  bool flow_past_said_ = false;
};

/// rank 0's text on every rank
void broadcast(MPI_Comm comm, std::string& text);

}  // namespace polyslip::drivers
