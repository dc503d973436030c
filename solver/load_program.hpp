#pragma once
// How far the load has come: strain, time and the stages of a load.

#include <array>
#include <optional>
#include <vector>

#include "solver/options.hpp"

namespace polyslip::solver {

/// The path of a load is the accumulated magnitude of its strain e, which only grows; it is what
/// steps, outputs and checkpoints count in, and equals e until the first reversal. e by type:
///   plane-strain-compression, uniaxial-compression: ln(h0/h);  uniaxial-tension: ln(h/h0),
///   h the height along `axis`;
///   simple-shear: the shear gamma;
///   velocity-gradient: its time integral of sqrt(2/3 D:D);
///   faces: strain_rate of [loading] times time, as far as every stage runs at that rate.
/// With "true-strain-rate" |de/dt| is the stage's rate; with "constant-velocity" it is the rate of
/// change of h/h0 (for the types without a height there is no difference).
class LoadProgram {
 public:
  explicit LoadProgram(const LoadingOptions& loading);

  /// The end if no target of stress is met before.
  double planned_end() const { return planned_end_; }
  bool finished() const { return stage_ == stages_.size(); }
  int stage() const { return static_cast<int>(stage_); }

  // Of the present stage; the last one's where the load is finished.
  double strain(double path) const;
  double time(double path) const;
  /// +1 or -1: sign of de/dt
  int direction() const { return direction_; }
  /// Path at which targets of strain and time end the stage.
  double stage_end() const { return stage_end_; }
  std::optional<double> stress_target() const;

  /// The load came to `path`. True if that ended a stage: by its strain or time, or because
  /// `stress_met`.
  bool advance(double path, bool stress_met);

  /// {stage, path, time, strain at the start of the stage}
  std::vector<double> history() const;
  /// Throws core::InternalError if `history` is not one of this load.
  void restore(const std::vector<double>& history);

 private:
  std::vector<LoadingStage> stages_;
  int stretch_ = 0;  // h/h0 = exp(stretch e) if not 0 and the velocity is constant
  std::size_t stage_ = 0;
  double path0_ = 0, time0_ = 0, strain0_ = 0;  // at the start of the stage
  int direction_ = 1;
  double stage_end_ = 0, planned_end_ = 0;

  void begin_stage(double path, double time, double strain);
  /// Change of e after `duration` seconds in this stage.
  double strain_change(double duration) const;
};

/// Stress that goes with the load strain [MPa]; stress: xx yy zz yz zx xy.
///   plane-strain-compression, uniaxial-compression: minus the normal stress along `axis`;
///   uniaxial-tension: plus; simple-shear: the shear stress; others: von Mises.
double load_stress(const LoadingOptions& loading, const std::array<double, 6>& stress);

/// von Mises stress of xx yy zz yz zx xy.
double von_mises(const std::array<double, 6>& stress);

}  // namespace polyslip::solver
