#pragma once
// Taylor's model: every orientation of a polycrystal sees the same deformation gradient.

#include <mpi.h>

#include <span>
#include <vector>

#include "material/point_driver.hpp"
#include "results/element_values.hpp"

namespace polyslip::drivers {

/// Orientations of equal volume, shared out over the ranks in blocks, each a material point of the
/// finite elements' law. The relative deformation gradient is the same for all (full constraints).
class TaylorModel {
 public:
  /// `orientations`: all of them, on every rank; at least one. The law must outlive the model.
  TaylorModel(MPI_Comm comm, const material::CrystalLaw& law,
              std::span<const core::Quaternion> orientations);

  int size() const { return count_; }
  /// Moves every point by f in `time_step` [s]. Returns how many did not converge, over all ranks;
  /// if there is one, nothing moves. Collective.
  long deform(const core::Mat3& relative_gradient, double time_step);

  /// Mean deviatoric Cauchy stress [MPa, Mandel, sample frame]. Collective.
  core::Vec6 mean_deviator() const;
  /// Mean of g over orientations and systems [MPa]. Collective.
  double mean_strength() const;
  /// Mean of the accumulated sum of |slip|. Collective.
  double mean_slip() const;

  /// Every orientation in order, on rank 0 (elsewhere empty): weights 1, and `mean_stress` [MPa]
  /// (tr sigma / 3) added to each deviator. Collective.
  results::ElementTable table(double mean_stress) const;

 private:
  /// Mean, over all orientations, of the sum or mean of a state field's components.
  double mean_state(const char* field, bool sum) const;
  double local_state(int point, const char* field, bool sum) const;

  MPI_Comm comm_;
  const material::CrystalLaw* law_;
  int count_ = 0, first_ = 0;
  std::vector<material::PointDriver> part_;  ///< none on a rank without orientations, else one
};

}  // namespace polyslip::drivers
