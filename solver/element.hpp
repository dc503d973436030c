#pragma once
// One ten-node tetrahedron in updated Lagrangian form (docs/theory-solver.md): forces and tangent
// on the current geometry x_{n+1}, either with one constant mean stress ("mixed") or with the mean
// stress of each point's own volume ratio ("displacement"), and with any rule of
// solver/reference_element.hpp.
//
// Array shapes: x[10][3] node positions; r[10][3] nodal forces; lane innermost in the arrays of
// the material (material/crystal_law.hpp): f[blocks][9][4], stress[blocks][6][4],
// tangent[blocks][54][4]; numbers of points mean_stress[slots] = [blocks][4].

#include <array>

#include "solver/reference_element.hpp"

namespace polyslip::solver {

using ElementPositions = std::array<std::array<double, 3>, element_nodes>;
using ElementForces = std::array<std::array<double, 3>, element_nodes>;
/// K[a][i][b][k] = d f_ai / d u_bk
using ElementMatrix =
    std::array<std::array<std::array<std::array<double, 3>, element_nodes>, 3>, element_nodes>;

/// An element's geometry at its quadrature points.
struct ElementGeometry {
  int points = 0;
  /// [point][direction][node] dN_a/dx_j on the given positions
  std::array<std::array<std::array<double, element_nodes>, 3>, max_element_points> gradients;
  std::array<double, max_element_points> weights;  ///< w det J [length^3]
  double volume = 0;                               ///< sum of the weights
  double min_jacobian_ratio = 0;                   ///< min det J / mean det J
};

/// Gradients and weights; false (contents unusable) if det J <= 0 or is NaN at a point.
bool element_geometry(const PointRule& rule, const ElementPositions& x, ElementGeometry& geometry);

/// f_ij = d x_{n+1,i} / d x_{n,j} at each point, from old and new positions and the new geometry,
/// and in the lanes that fill the last block; false if it is not invertible.
bool relative_gradients(const ElementPositions& x_old, const ElementPositions& x,
                        const ElementGeometry& geometry, double* f);

/// h_kl = d u_k / d x_l at each point, of displacements u on the geometry; h: [blocks][9][4], entry
/// 3 k + l, zero in the lanes that fill the last block.
void displacement_gradients(const ElementPositions& u, const ElementGeometry& geometry, double* h);

/// f_ai = sum_q w J (sigma'_ij + p delta_ij) dN_a/dx_j  [stress x length^2]
/// stress: deviatoric Cauchy stress; mean_stress[q]: p.
void element_forces(const ElementGeometry& geometry, const double* stress,
                    const double* mean_stress, ElementForces& forces);

/// b_ai = dV/du_ai = sum_q w J dN_a/dx_i
void element_volume_gradient(const ElementGeometry& geometry, ElementForces& gradient);

/// Exact derivative of element_forces at constant p. With h = d(delta u)/dx and
///   d sigma'_ij = D_ijkl h_kl (the law's tangent),
///   K_aibk = sum_q w J dN_a/dx_j M_ijkl dN_b/dx_l,
///   M_ijkl = D_ijkl + sigma_ij delta_kl - sigma_il delta_jk + bulk delta_ij delta_kl
/// `bulk` is K for the displacement element (dp = K tr h) and 0 for the mixed one.
void element_tangent(const ElementGeometry& geometry, const double* stress, const double* tangent,
                     const double* mean_stress, double bulk, ElementMatrix& matrix);

/// Volume mean over the points of half the geometric mean of the tangent's eigenvalues on the five
/// deviatoric modes, det^(1/5)/2 [MPa]; 2 mu times the identity gives mu.
double element_shear_modulus(const ElementGeometry& geometry, const double* tangent);

}  // namespace polyslip::solver
