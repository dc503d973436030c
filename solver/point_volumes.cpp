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

PointVolumeSpring point_volume_spring(const ElementGeometry& geometry, const double* volume_ratio,
                                      double kappa) {
  PointVolumeSpring spring;
  spring.kappa = kappa;
  double start = 0;  // V_n
  for (int q = 0; q < element_points; ++q) {
    spring.reference[q] = geometry.weights[q] / volume_ratio[q];
    start += spring.reference[q];
  }
  const double whole = std::log(geometry.volume / start);
  for (int q = 0; q < element_points; ++q) {
    spring.s[q] = std::log(volume_ratio[q]) - whole;
    spring.sum += spring.reference[q] * spring.s[q];
  }
  return spring;
}

std::array<double, element_points> spring_mean_stress(const PointVolumeSpring& spring,
                                                      const ElementGeometry& geometry) {
  std::array<double, element_points> p{};
  for (int q = 0; q < element_points; ++q)
    p[q] = spring.kappa *
           (spring.reference[q] * spring.s[q] / geometry.weights[q] - spring.sum / geometry.volume);
  return p;
}

void add_spring_tangent(const PointVolumeSpring& spring, const ElementGeometry& geometry,
                        ElementMatrix& matrix) {
  std::array<Gradient, element_points> g;
  Gradient mean{}, weighted{};  // G, sum W g
  double reference = 0;         // sum W
  for (int q = 0; q < element_points; ++q) {
    g[q] = divergence(geometry, q);
    reference += spring.reference[q];
    for (int i = 0; i < dofs; ++i) {
      mean[i] += geometry.weights[q] / geometry.volume * g[q][i];
      weighted[i] += spring.reference[q] * g[q][i];
    }
  }
  double* out = &matrix[0][0][0][0];
  for (int row = 0; row < dofs; ++row)
    for (int c = 0; c < dofs; ++c) {
      double sum = (reference + spring.sum) * mean[row] * mean[c] - weighted[row] * mean[c] -
                   mean[row] * weighted[c];
      for (int q = 0; q < element_points; ++q)
        sum += spring.reference[q] * (1 - spring.s[q]) * g[q][row] * g[q][c];
      out[dofs * row + c] += spring.kappa * sum;
    }
}

}  // namespace polyslip::solver
