#pragma once
// The deforming polycrystal: state on every rank, one step at a time.

#include <mpi.h>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "material/crystal_law.hpp"
#include "mesh/snapshot.hpp"
#include "solver/boundary.hpp"
#include "solver/flat_faces.hpp"
#include "solver/options.hpp"
#include "solver/profile.hpp"

namespace polyslip::solver {

/// One accepted step: a row of macro.csv.
struct StepRecord {
  double strain = 0, time = 0, step_size = 0;  ///< path of the load at the end of the step, time,
                                               ///< path of the step; 1, s, 1
  std::array<double, 6> stress{};              ///< xx yy zz yz zx xy, volume average, MPa
  double fx_x1 = 0, fy_y1 = 0, fz_z1 = 0;      ///< force of the surroundings on the body, MPa L^2
  std::array<std::array<double, 3>, 6> face_forces{};  ///< all faces x0 ... z1
  double load_strain = 0, load_stress = 0;             ///< solver/load_program.hpp; 1, MPa
  int newton_iterations = 0, linear_iterations = 0;    ///< of this step, cut attempts included
  int cuts = 0;                                        ///< attempts that failed before this one
  double min_jacobian_ratio = 1;                       ///< worst element: min det J / mean det J
};

/// No step converged, however small.
class StepFailure : public core::RecoverableError {
 public:
  /// tried: counters of the attempts.
  StepFailure(const std::string& reason, const StepRecord& tried_in_vain)
      : RecoverableError(reason), tried(tried_in_vain) {}
  StepRecord tried;
};

/// A step may be cut as often as min_strain_increment lets it.
inline constexpr int any_cuts = std::numeric_limits<int>::max();

/// A rank's elements and their nodes, first those that this rank owns.
struct MeshPart {
  std::span<const std::array<int, 10>> elements;      ///< numbers of the nodes here
  std::size_t owned_nodes = 0;                        ///< each node of the body is owned once
  std::vector<core::Vec3> initial, positions, rates;  ///< [nodes] at zero strain; now; change of
                                                      ///< the positions per unit strain in the last
                                                      ///< step beyond the homogeneous motion, zero
                                                      ///< at the start of a stage
};

using SnapshotUse = std::function<void(mesh::Snapshot& outline, const mesh::FieldReader& read)>;

/// Collective throughout. Snapshots live on rank 0 (others pass anything). Between two of them no
/// rank holds a field of the whole body; rank 0 keeps the mesh as it was at the start.
class Model {
 public:
  /// From a snapshot with mesh and state fields (a fresh one, a remeshed one or a checkpoint).
  /// History in the snapshot, if there, is taken up; a stored partition is used if it was made for
  /// the same number of ranks. `profile`, if there is one, must outlive the model and books where
  /// this rank's time goes.
  Model(MPI_Comm comm, mesh::Snapshot snapshot, const material::CrystalLaw& law,
        const LoadingOptions& loading, const SolverOptions& options,
        std::function<void(const std::string&)> log, Profile* profile = nullptr);
  /// The same under another boundary than the deck's, as a function of its load's strain, and
  /// without an end.
  Model(MPI_Comm comm, mesh::Snapshot snapshot, const material::CrystalLaw& law, Boundary boundary,
        const LoadingOptions& loading, const SolverOptions& options,
        std::function<void(const std::string&)> log, Profile* profile = nullptr);
  ~Model();
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// Path of the load (solver/load_program.hpp).
  double strain() const;
  double time() const;
  /// Whether the load has come to its end.
  bool finished() const;
  /// One accepted step that does not pass `target_strain` nor the end of the load's stage. Throws
  /// core::InternalError if the load is finished, StepFailure, on every rank,
  /// when the step falls below the smallest one or was cut `max_cuts` times in vain; the state is
  /// then that of the last accepted step.
  StepRecord step(double target_strain, int max_cuts = any_cuts);
  /// Brings the stresses of the snapshot (carried over a remeshing) to equilibrium with the
  /// boundary held, in a time too short to flow. Throws core::RecoverableError, on every rank, if
  /// Newton's method does not converge.
  void relax();
  /// Drops what a restart would not have (multigrid set-up, ...). Call when a checkpoint is due.
  void drop_setup();
  /// How far the body has flowed past the planes of its flat faces; the same on every rank.
  FlowPast past_flat_faces() const;
  /// This rank's part of the mesh and how it moves. Valid until the next step.
  MeshPart part() const;
  /// Mesh, state, derived fields and history on rank 0; an empty snapshot elsewhere.
  mesh::Snapshot snapshot() const;
  /// Calls `use` on rank 0 with the snapshot's outline and a reader of its fields, which the other
  /// ranks answer: for files, without a field of the whole body on any rank. An exception of `use`
  /// is thrown on every rank.
  void show(const SnapshotUse& use) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A fresh snapshot: the state of an undeformed mesh whose grains have these orientations.
mesh::Snapshot initial_snapshot(mesh::Mesh mesh, const std::vector<core::Quaternion>& orientations,
                                const material::CrystalLaw& law, int quadrature_points = 4);

}  // namespace polyslip::solver
