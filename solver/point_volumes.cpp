#include "solver/point_volumes.hpp"

#include <algorithm>
#include <cmath>

namespace polyslip::solver {
namespace {

constexpr int dofs = 3 * element_nodes;
using Gradient = std::array<double, dofs>;

/// d(div u)_q/du
Gradient divergence(const ElementGeometry& geometry, int q) {
  Gradient g{};
  for (int a = 0; a < element_nodes; ++a)
    for (int i = 0; i < 3; ++i) g[3 * a + i] = geometry.gradients[q][i][a];
  return g;
}

}  // namespace

double point_volume_modulus(double von_mises_stress, double strain_increment,
                            double shear_modulus) {
  return std::min(point_volume_share * von_mises_stress / (3 * std::abs(strain_increment)),
                  point_volume_limit * shear_modulus);
}

PointVolumeResistance point_volume_resistance(const ElementGeometry& geometry,
                                              const double* volume_ratio, double kappa) {
  PointVolumeResistance resistance;
  resistance.kappa = kappa;
  double start = 0;  // V_n
  for (int q = 0; q < geometry.points; ++q) {
    resistance.reference[q] = geometry.weights[q] / volume_ratio[q];
    start += resistance.reference[q];
  }
  const double whole = std::log(geometry.volume / start);
  for (int q = 0; q < geometry.points; ++q) {
    resistance.s[q] = std::log(volume_ratio[q]) - whole;
    resistance.sum += resistance.reference[q] * resistance.s[q];
  }
  return resistance;
}

std::array<double, max_element_slots> resistance_mean_stress(
    const PointVolumeResistance& resistance, const ElementGeometry& geometry) {
  std::array<double, max_element_slots> p{};
  for (int q = 0; q < geometry.points; ++q)
    p[q] = resistance.kappa * (resistance.reference[q] * resistance.s[q] / geometry.weights[q] -
                               resistance.sum / geometry.volume);
  return p;
}

void add_resistance_tangent(const PointVolumeResistance& resistance,
                            const ElementGeometry& geometry, ElementMatrix& matrix) {
  std::array<Gradient, max_element_points> g;
  Gradient mean{}, weighted{};  // G, sum W g
  double reference = 0;         // sum W
  for (int q = 0; q < geometry.points; ++q) {
    g[q] = divergence(geometry, q);
    reference += resistance.reference[q];
    for (int i = 0; i < dofs; ++i) {
      mean[i] += geometry.weights[q] / geometry.volume * g[q][i];
      weighted[i] += resistance.reference[q] * g[q][i];
    }
  }
  double* out = &matrix[0][0][0][0];
  for (int row = 0; row < dofs; ++row)
    for (int c = 0; c < dofs; ++c) {
      double sum = (reference + resistance.sum) * mean[row] * mean[c] - weighted[row] * mean[c] -
                   mean[row] * weighted[c];
      for (int q = 0; q < geometry.points; ++q)
        sum += resistance.reference[q] * (1 - resistance.s[q]) * g[q][row] * g[q][c];
      out[dofs * row + c] += resistance.kappa * sum;
    }
}

}  // namespace polyslip::solver
