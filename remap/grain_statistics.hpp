#pragma once
// What the audit of a remeshing compares, grain by grain.

#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// Of a field with one component over a grain: mean weighted by volume, and extremes.
struct FieldStatistics {
  double mean = 0, min = 0, max = 0;
};

struct GrainStatistics {
  double volume = 0;                   ///< L^3, by the rule of the snapshot's points
  double volume_at_zero_pressure = 0;  ///< L^3; the volume if the snapshot has no such one
  /// Weighted by volume (core::mean_rotation). Identity if the snapshot has no orientations.
  core::Quaternion orientation = core::Quaternion::Identity();
  double spread = 0;        ///< mean angle of the points' orientations from it [degrees], by volume
  FieldStatistics g, slip;  ///< MPa, 1; zeros if the snapshot has none
  double elastic_energy = 0;  ///< MPa L^3
};

/// Orientations within a grain are compared without symmetry operations, of which a run applies
/// none. Elastic energy: the integral of 1/2 s : e + 1/2 sigma_m ln(V/V0), with the deviatoric
/// stress s in crystal axes and e "elastic_strain", sigma_m the mean normal stress and V0
/// "reference_volume". `threads` share the grains.
std::vector<GrainStatistics> grain_statistics(const mesh::Snapshot& snapshot, int threads = 1);

}  // namespace polyslip::remap
