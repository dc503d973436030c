#pragma once
// Forces, volumes and tangent of this rank's elements, summed over the mesh.

#include <cstdint>
#include <string>
#include <vector>

#include "material/crystal_law.hpp"
#include "solver/element.hpp"
#include "solver/linear_blocks.hpp"
#include "solver/partition.hpp"
#include "solver/point_volumes.hpp"

namespace polyslip::solver {

/// The body at one instant, as far as this rank knows it. The points of an element stand in blocks,
/// the last one filled with repetitions (solver/reference_element.hpp).
struct Configuration {
  std::vector<double> x;             ///< [local_nodes][3] positions
  std::vector<double> p;             ///< [elements] mean stress [MPa], mixed element
  std::vector<double> volume_ratio;  ///< [elements][slots] det F of the point since V0
  std::vector<double> state;         ///< [elements][blocks][law size][4] of the material
};

/// Why a configuration cannot be evaluated.
enum class Evaluation : int { fine = 0, inverted = 1, point_failed = 2, not_finite = 3 };
std::string describe(Evaluation evaluation);

/// Linear solves to this relative tolerance or less take other settings than those to 1e-2
/// (measured: docs/benchmarks.md, solves to 1e-8).
inline constexpr double tight_tolerance = 1e-4;

/// Weight of the augmentation by the elements' volume gradients, relative to the local tangent
/// shear modulus. To 1e-2 the smoother counts, which a large weight slows down; to 1e-8 the few
/// pressures that the mesh hardly controls do, and the larger it is the fewer iterations they take.
inline constexpr double augmentation_weight(double linear_tolerance) {
  return linear_tolerance > tight_tolerance ? 4 : 40;
}

/// Of the material: the law's own, or corrected by the change of the stress since the last
/// linearisation, which has to be of the same step (solver/secant_tangent.hpp).
enum class Tangent { of_law, secant };

class Discretisation {
 public:
  /// Collective. reference_volume: [elements] V0, empty: the volumes of x.
  Discretisation(const LocalMesh& local, const NodeExchange& exchange,
                 const material::CrystalLaw& law, bool mixed, const PointRule& rule,
                 const std::vector<double>& x, std::vector<double> reference_volume);

  /// Stresses, new state, forces and volume residuals at positions x and mean stresses p, reached
  /// from `old` in `time_step` [s]; kappa: modulus of solver/point_volumes.hpp [MPa], mixed
  /// element. Same answer on every rank. Unless `fine`, the results below are unusable. Collective.
  Evaluation evaluate(const Configuration& old, const std::vector<double>& x,
                      const std::vector<double>& p, double time_step, double kappa);

  /// The linearised equations at the last evaluation; weight: of the augmentation. Rows and columns
  /// of the mean stresses are scaled by `pressure_scale`: [A B^T; B -C] becomes [A B^T D; D B -D C
  /// D]. Valid until the next evaluation.
  LinearBlocks linearise(double weight, Tangent tangent);

  /// Action of the tangent of these elements on displacements u [local_nodes][3] and mean stresses
  /// p [elements], nothing eliminated: forces A u + B^T p (complete on owned nodes) and volumes B u
  /// of the elements, unscaled; zeros elsewhere. Collective.
  void apply_tangent(const std::vector<int>& elements, const std::vector<double>& u,
                     const std::vector<double>& p, std::vector<double>& forces,
                     std::vector<double>& volumes) const;

  /// D of an element: W |b|, which makes a volume residual the force that the augmentation makes of
  /// it, so that a linear solver's norm sees both.
  double pressure_scale(std::size_t element) const { return scale_[element]; }

  /// Takes the last evaluation's state as `configuration`'s.
  void accept(const std::vector<double>& x, const std::vector<double>& p,
              Configuration& configuration) const;

  // Results of the last evaluation.
  /// [local_nodes][3] internal forces, complete on owned nodes
  const std::vector<double>& forces() const { return forces_; }
  /// [elements] ln(V/V0) - p/K; zeros for the displacement element
  const std::vector<double>& volume_gap() const { return volume_gap_; }
  const std::vector<double>& volumes() const { return volumes_; }
  const std::vector<double>& reference_volumes() const { return reference_volumes_; }
  /// [elements][points][6] Cauchy stress xx yy zz yz zx xy, plain components [MPa]
  std::vector<double> cauchy_stress() const;
  /// [elements][6] its mean over the element, by the same quadrature
  std::vector<double> element_stress() const;
  /// Mean over the body. Collective.
  std::array<double, 6> mean_stress() const;
  /// min det J / mean det J of the worst element. Collective.
  double min_jacobian_ratio() const;

  bool mixed() const { return mixed_; }
  const PointRule& rule() const { return rule_; }
  const LocalMesh& local() const { return local_; }
  const NodeExchange& exchange() const { return exchange_; }
  const material::CrystalLaw& law() const { return law_; }

 private:
  const LocalMesh& local_;
  const NodeExchange& exchange_;
  const material::CrystalLaw& law_;
  bool mixed_;
  const PointRule& rule_;
  std::size_t slots_;  // of an element, rule_.slots
  double bulk_, shear_;
  std::vector<double> scale_, C_, W_, schur_;  // [elements] of the linear blocks
  std::vector<double> reference_, departure_;  // [elements][slots] of the points' volume resistance
  std::vector<double> reference_volumes_, volumes_, volume_gap_, jacobian_ratios_, volume_ratio_;
  std::vector<double> step_ratio_;  // [elements][slots] det f of the point over the step
  double kappa_ = 0;
  std::vector<double> x_, f_, state_, stress_, tangent_, forces_;
  std::vector<double> mean_stress_;  // [elements][slots]
  std::vector<material::PointStatus> status_;
  std::vector<double> linearised_x_, linearised_stress_;  // of the last linearisation

  ElementPositions positions(int element, const std::vector<double>& x) const;
  bool geometry_of(std::size_t element, ElementGeometry& geometry) const;
  PointVolumeResistance resistance(std::size_t element, const ElementGeometry& geometry) const;
  /// Adds the resistance's mean stresses to those of the element's points.
  void add_point_volumes(std::size_t element);
  Evaluation kinematics(const Configuration& old);
  Evaluation update_material(const Configuration& old, double time_step);
  void sum_forces();
  /// W V of an element [MPa]: no more than K, where W = 1/C condenses the pressure exactly.
  double augmentation(double modulus, double weight) const;
  void linearise_element(std::size_t element, double weight);
  void match_last_change(std::size_t element);
};

}  // namespace polyslip::solver
