#include "solver/element.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tensor.hpp"

namespace polyslip::solver {
namespace {

/// a^-1, given det a.
void invert(const double a[3][3], double det, double inverse[3][3]) {
  const double s = 1 / det;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      inverse[j][i] = s * (a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1]);
    }
}

double determinant(const double a[3][3]) {
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/// Mandel component and the factor from it to the plain one of the entry ij.
constexpr int mandel[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
const double half_sqrt2 = std::sqrt(0.5);
double plain(int i, int j) { return i == j ? 1.0 : half_sqrt2; }

void cauchy(const double* stress, double p, int q, double sigma[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      sigma[i][j] = stress[PointRule::at(6, mandel[i][j], q)] * plain(i, j) + (i == j ? p : 0);
}

/// M_ijkl of element_tangent at point q.
void moduli(const double* stress, const double* tangent, double p, double bulk, int q,
            double M[3][3][3][3]) {
  double sigma[3][3];
  cauchy(stress, p, q, sigma);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          double m = tangent[PointRule::at(54, 9 * mandel[i][j] + 3 * k + l, q)] * plain(i, j);
          if (k == l) m += sigma[i][j];
          if (j == k) m -= sigma[i][l];
          if (i == j && k == l) m += bulk;
          M[i][j][k][l] = m;
        }
}

/// The five deviatoric modes, orthonormal: as Mandel vectors and as 3 x 3 tensors (entry 3 k + l).
struct DeviatorBasis {
  Eigen::Matrix<double, 6, 5> mandel;
  Eigen::Matrix<double, 9, 5> plain;
};

DeviatorBasis make_deviator_basis() {
  DeviatorBasis basis;
  for (int mode = 0; mode < 5; ++mode) {
    const core::Mat3 tensor = core::from_deviator5(core::Vec5::Unit(mode));
    basis.mandel.col(mode) = core::mandel(tensor);
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) basis.plain(3 * k + l, mode) = tensor(k, l);
  }
  return basis;
}

const DeviatorBasis& deviator_basis() {
  static const DeviatorBasis basis = make_deviator_basis();
  return basis;
}

}  // namespace

bool element_geometry(const PointRule& rule, const ElementPositions& x, ElementGeometry& geometry) {
  geometry.points = rule.points;
  geometry.volume = 0;
  double smallest = std::numeric_limits<double>::max(), mean = 0;
  for (int q = 0; q < rule.points; ++q) {
    const auto &reference = rule.point_gradients[q], &mapping = rule.point_mapping[q];
    double jacobian[3][3] = {};  // dx_i/dxi_j
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int a = 0; a < element_nodes; ++a) jacobian[i][j] += x[a][i] * mapping[j][a];
    const double det = determinant(jacobian);
    if (!(det > 0)) return false;
    double inverse[3][3];  // dxi_j/dx_i at [j][i]
    invert(jacobian, det, inverse);
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < element_nodes; ++a)
        geometry.gradients[q][i][a] = reference[0][a] * inverse[0][i] +
                                      reference[1][a] * inverse[1][i] +
                                      reference[2][a] * inverse[2][i];
    geometry.weights[q] = rule.weights[q / material::lanes][q % material::lanes] * det;
    geometry.volume += geometry.weights[q];
    smallest = std::min(smallest, det);
    mean += det / rule.points;
  }
  geometry.min_jacobian_ratio = smallest / mean;
  return true;
}

bool relative_gradients(const ElementPositions& x_old, const ElementPositions& x,
                        const ElementGeometry& geometry, double* f) {
  for (int q = 0; q < geometry.points; ++q) {
    // f^-1 = dx_{n,i}/dx_{n+1,j} = delta_ij - du_i/dx_{n+1,j}
    double inverse[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int a = 0; a < element_nodes; ++a)
          inverse[i][j] -= (x[a][i] - x_old[a][i]) * geometry.gradients[q][j][a];
    const double det = determinant(inverse);
    if (!(det > 0)) return false;
    double forward[3][3];
    invert(inverse, det, forward);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f[PointRule::at(9, 3 * i + j, q)] = forward[i][j];
  }
  const int last = geometry.points - 1;
  for (int q = geometry.points; q % material::lanes != 0; ++q)
    for (int k = 0; k < 9; ++k) f[PointRule::at(9, k, q)] = f[PointRule::at(9, k, last)];
  return true;
}

void displacement_gradients(const ElementPositions& u, const ElementGeometry& geometry, double* h) {
  for (int q = 0; q < geometry.points; ++q)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        double sum = 0;
        for (int a = 0; a < element_nodes; ++a) sum += u[a][k] * geometry.gradients[q][l][a];
        h[PointRule::at(9, 3 * k + l, q)] = sum;
      }
  for (int q = geometry.points; q % material::lanes != 0; ++q)
    for (int k = 0; k < 9; ++k) h[PointRule::at(9, k, q)] = 0;
}

void element_forces(const ElementGeometry& geometry, const double* stress,
                    const double* mean_stress, ElementForces& forces) {
  for (auto& r : forces) r = {0, 0, 0};
  for (int q = 0; q < geometry.points; ++q) {
    double sigma[3][3];
    cauchy(stress, mean_stress[q], q, sigma);
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        forces[a][i] += geometry.weights[q] * (sigma[i][0] * geometry.gradients[q][0][a] +
                                               sigma[i][1] * geometry.gradients[q][1][a] +
                                               sigma[i][2] * geometry.gradients[q][2][a]);
  }
}

void element_volume_gradient(const ElementGeometry& geometry, ElementForces& gradient) {
  for (auto& b : gradient) b = {0, 0, 0};
  for (int q = 0; q < geometry.points; ++q)
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        gradient[a][i] += geometry.weights[q] * geometry.gradients[q][i][a];
}

void element_tangent(const ElementGeometry& geometry, const double* stress, const double* tangent,
                     const double* mean_stress, double bulk, ElementMatrix& matrix) {
  double* out = &matrix[0][0][0][0];
  std::fill(out, out + 900, 0.0);
  for (int q = 0; q < geometry.points; ++q) {
    double M[3][3][3][3];
    moduli(stress, tangent, mean_stress[q], bulk, q, M);
    const auto& g = geometry.gradients[q];
    for (int i = 0; i < 3; ++i) {
      double T[3][30];  // [j][3 b + k] = w J M_ijkl dN_b/dx_l
      for (int j = 0; j < 3; ++j)
        for (int b = 0; b < element_nodes; ++b)
          for (int k = 0; k < 3; ++k)
            T[j][3 * b + k] =
                geometry.weights[q] *
                (M[i][j][k][0] * g[0][b] + M[i][j][k][1] * g[1][b] + M[i][j][k][2] * g[2][b]);
      for (int a = 0; a < element_nodes; ++a) {
        double* row = out + 90 * a + 30 * i;
        for (int c = 0; c < 30; ++c)
          row[c] += g[0][a] * T[0][c] + g[1][a] * T[1][c] + g[2][a] * T[2][c];
      }
    }
  }
}

double element_shear_modulus(const ElementGeometry& geometry, const double* tangent) {
  const DeviatorBasis& basis = deviator_basis();
  double mu = 0;
  for (int q = 0; q < geometry.points; ++q) {
    Eigen::Matrix<double, 6, 9> D;
    for (int i = 0; i < 6; ++i)
      for (int kl = 0; kl < 9; ++kl) D(i, kl) = tangent[PointRule::at(54, 9 * i + kl, q)];
    const Eigen::Matrix<double, 5, 5> modes = basis.mandel.transpose() * D * basis.plain;
    mu += geometry.weights[q] / geometry.volume *
          std::pow(std::max(modes.determinant(), 0.0), 0.2) / 2;
  }
  return mu;
}

}  // namespace polyslip::solver
