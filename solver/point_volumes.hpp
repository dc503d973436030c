#pragma once
// What keeps the volume of an element's points together (docs/theory-solver.md, points' volumes).
//
// One constant mean stress ties the volume of the whole element; the deviatoric law does not see
// the volume of a point. Where the points' volume ratios drift apart the element folds long before
// it need (measured on 30 grains at strain 0.3: ratios from 0.39 to 1.87). A weak spring pulls them
// back, with the energy
//   U = kappa/2 sum_q W_q s_q^2,   s_q = ln J_q - ln(V/V0),   J_q = w_q / W_q,
// w_q the volume that point q stands for and W_q that volume at J = 1. Flow preserves the volume of
// every point, so s = 0 in the exact solution: the spring is consistent for any kappa. kappa = K
// would be the displacement element, which locks mildly.

#include <array>

#include "solver/element.hpp"

namespace polyslip::solver {

/// kappa over the elastic shear modulus. With 0.02, about 540 MPa for aluminium, against a flow
/// stress of 20 MPa, points keep their volumes to some per cent.
inline constexpr double point_volume_share = 0.02;

struct PointVolumeSpring {
  double kappa = 0;                                ///< MPa
  std::array<double, element_points> reference{};  ///< W_q [length^3]
  std::array<double, element_points> s{};          ///< s_q
  double sum = 0;                                  ///< sum_q W_q s_q
};

/// volume_ratio[q]: J_q; reference_volume: V0.
PointVolumeSpring point_volume_spring(const ElementGeometry& geometry, const double* volume_ratio,
                                      double reference_volume, double kappa);

/// The mean stress that the spring adds at each point [MPa], from dU = sum_q w_q p_q div(du)_q:
///   p_q = kappa (W_q s_q / w_q - sum_r W_r s_r / V); its mean over the element is zero.
std::array<double, element_points> spring_mean_stress(const PointVolumeSpring& spring,
                                                      const ElementGeometry& geometry);

/// Adds what the change of these mean stresses gives to the tangent; element_tangent has the part
/// at constant mean stress. With g_q = d(div u)_q/du (30 numbers) and G = sum_q w_q g_q / V:
///   kappa [sum_q W_q (1 - s_q) g_q g_q^T - (sum W g) G^T - G (sum W g)^T + (sum W + sum W s) G
///   G^T]
void add_spring_tangent(const PointVolumeSpring& spring, const ElementGeometry& geometry,
                        ElementMatrix& matrix);

}  // namespace polyslip::solver
