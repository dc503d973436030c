#pragma once
// A polycrystal without a mesh: every crystal sees the same velocity gradient (full constraints,
// Taylor's assumption), the stress is the mean over the crystals.

#include <span>
#include <vector>

#include "material/crystal_law.hpp"

namespace polyslip::material {

/// exp(a), by Taylor's series of a/2^k, squared k times.
core::Mat3 exponential(const core::Mat3& a);

/// N orientations on a regular spread over all rotations: Alexa's super-Fibonacci spiral (CVPR
/// 2022). Far closer to uniform than N random ones.
std::vector<core::Quaternion> spread_orientations(int count);

/// Material points of equal volume driven by one velocity gradient. Single use of memory: four
/// points a block, the last block filled up with copies of the last point, which count nowhere.
class PointDriver {
 public:
  /// The law must outlive the driver. Throws core::InternalError without an orientation.
  PointDriver(const CrystalLaw& law, std::span<const core::Quaternion> orientations);

  int size() const { return count_; }
  /// Moves every point by f = exp(velocity_gradient * time_step) [1/s, s; sample frame]. Returns
  /// the number of points that did not converge; if there is one, nothing moves.
  int advance(const core::Mat3& velocity_gradient, double time_step);
  /// The same for a given relative deformation gradient.
  int deform(const core::Mat3& relative_gradient, double time_step);

  /// Mean deviatoric Cauchy stress [MPa], Mandel, sample frame; zero before the first step.
  core::Vec6 mean_stress() const;
  /// Of one point, as mean_stress.
  core::Vec6 stress(int point) const;
  core::Quaternion orientation(int point) const;
  /// Component `component` of the law's state at a point.
  double state(int point, int component) const;

 private:
  const CrystalLaw* law_;
  int count_ = 0, blocks_ = 0;
  std::vector<double> old_, new_, stress_, new_stress_, gradient_;
  std::vector<PointStatus> status_;
};

}  // namespace polyslip::material
