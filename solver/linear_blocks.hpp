#pragma once
// What the linear solver is given: the distributed mesh with its Dirichlet dofs, and the linearised
// equations element by element. Nothing is assembled but the vertex level.

#include <cstdint>
#include <vector>

#include "solver/partition.hpp"
#include "solver/reference_element.hpp"

namespace polyslip::solver {

/// The unknowns: three displacements a node, then one pressure an element (mixed element).
struct LinearLayout {
  const LocalMesh* local = nullptr;
  const NodeExchange* exchange = nullptr;
  bool mixed = true;  ///< else the displacement element, without pressures
  const PointRule* rule = &point_rule(4);
  std::vector<double> coordinates;        ///< [owned_nodes][3], for the rigid-body modes
  std::vector<std::uint8_t> constrained;  ///< [local_nodes][3] Dirichlet dofs

  std::size_t displacements() const { return 3 * static_cast<std::size_t>(local->owned_nodes); }
  std::size_t pressures() const { return mixed ? local->elements.size() : 0; }
};

/// The blocks of the saddle-point system, on the element level (solver/element.hpp). The points of
/// an element stand in blocks of four (solver/reference_element.hpp). The arrays must live as long
/// as the blocks are used.
///   A: sum over the elements of element_tangent + add_resistance_tangent
///   B: a row D_e b_e an element, b_e = dV_e/du;  C, W, S: one number an element
/// Rows and columns of Dirichlet dofs are left out by the solver. The augmentation W D^2 is one
/// positive number an element; min(w mu_e, K) / V_e is a good one (1/C condenses the pressure
/// exactly), mu_e being half the geometric mean of the five eigenvalues of the deviatoric tangent:
/// det^(1/5) / 2, meaned over the points (with the harmonic mean iterations double). D scales the
/// volume residuals to forces, so that a 2-norm sees both.
struct LinearBlocks {
  const double* x = nullptr;            ///< [local_nodes][3] positions
  const double* stress = nullptr;       ///< [elements][blocks][6][4] deviatoric, Mandel
  const double* tangent = nullptr;      ///< [elements][blocks][54][4] of the law
  const double* mean_stress = nullptr;  ///< [elements][blocks][4]
  double bulk = 0;                      ///< K of the displacement element, 0 of the mixed one
  double kappa = 0;                     ///< of solver/point_volumes.hpp
  const double* reference = nullptr;    ///< likewise, W_q; read if kappa > 0
  const double* departure = nullptr;    ///< likewise, s_q
  // Of the mixed element, [elements]; null for the displacement element.
  const double* scale = nullptr;  ///< D
  const double* C = nullptr;      ///< D^2 V / K
  const double* W = nullptr;      ///< augmentation
  /// C + (1 - W C) / (D^-2 mu_e / V + W): diagonal Schur complement of the augmented system,
  /// positive; with W D^2 = w mu_e / V and K >> mu_e it is D^2 V (1/((1 + w) mu_e) + 1/K).
  const double* schur = nullptr;
};

}  // namespace polyslip::solver
