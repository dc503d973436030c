#pragma once
// What keeps the volumes of an element's points together (docs/theory-solver.md, points' volumes).
//
// One constant mean stress ties the volume of the whole element; the deviatoric law does not see
// the volume of a point. Where the points' volumes drift apart an element folds long before it need
// (measured on 30 grains at strain 0.3: ratios from 0.39 to 1.87). So a departure of a point's
// volume rate from its element's is resisted, over a step from x_n to x_{n+1} by the energy
//   U = kappa/2 sum_q W_q s_q^2,   s_q = ln J_q - ln(V/V_n),   J_q = w_q / W_q,
// w_q and W_q the volumes that point q stands for at the end and at the start of the step. Flow
// preserves the volume of every point, so s = 0 in the exact solution: the term is consistent. It
// is a viscous one, kappa = share * sigma / (3 delta eps) with the macroscopic von Mises stress and
// strain increment, and so neither depends on the step nor remembers: an elastic one stiffened the
// body by 0.5 % over a strain of 0.3, which a remeshing then lost.

#include <array>

#include "solver/element.hpp"

namespace polyslip::solver {

/// kappa over the macroscopic shear viscosity times 1/time step, sigma / (3 delta eps).
inline constexpr double point_volume_share = 4;
/// Largest kappa over the elastic shear modulus, for the linear solver's sake in steps cut below
/// 1e-4. A limit that longer steps reach takes the resistance away as the step falls, and so
/// changes what the steps converge to (docs/verification.md, size of the steps).
inline constexpr double point_volume_limit = 20;

/// kappa [MPa] of a step: von Mises stress of the body before it [MPa], its strain increment.
double point_volume_modulus(double von_mises_stress, double strain_increment, double shear_modulus);

struct PointVolumeResistance {
  double kappa = 0;                                   ///< MPa
  std::array<double, max_element_slots> reference{};  ///< W_q [length^3], 0 beyond the points
  std::array<double, max_element_slots> s{};          ///< s_q, 0 likewise
  double sum = 0;                                     ///< sum_q W_q s_q
};

/// volume_ratio[q]: J_q over the step.
PointVolumeResistance point_volume_resistance(const ElementGeometry& geometry,
                                              const double* volume_ratio, double kappa);

/// The mean stress that the resistance adds at each point [MPa], from dU = sum_q w_q p_q div(du)_q:
///   p_q = kappa (W_q s_q / w_q - sum_r W_r s_r / V); its mean over the element is zero.
std::array<double, max_element_slots> resistance_mean_stress(
    const PointVolumeResistance& resistance, const ElementGeometry& geometry);

/// Adds what the change of these mean stresses gives to the tangent; element_tangent has the part
/// at constant mean stress. With g_q = d(div u)_q/du (30 numbers) and G = sum_q w_q g_q / V:
///   kappa [sum_q W_q (1 - s_q) g_q g_q^T - (sum W g) G^T - G (sum W g)^T + (sum W + sum W s) G
///   G^T]
void add_resistance_tangent(const PointVolumeResistance& resistance,
                            const ElementGeometry& geometry, ElementMatrix& matrix);

}  // namespace polyslip::solver
