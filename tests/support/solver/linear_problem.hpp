#pragma once
// Saddle-point systems to try linear solvers on: a cube of quadratic tetrahedra with a polycrystal
// of cube-shaped grains, whose tangents look like those of a crystal under flow.

#include <cstdint>
#include <memory>
#include <vector>

#include "solver/element.hpp"
#include "solver/linear_blocks.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::test {

struct LinearProblemOptions {
  int cells = 4;   ///< per side; six tetrahedra a cell
  int grains = 2;  ///< per side
  double bulk_to_shear =
      250;              ///< K / mean mu_e, mu_e: half the geometric mean of a tangent's eigenvalues
  double softest = 70;  ///< about the smallest eigenvalue of a tangent, MPa
  double stiffest = 50e3;  ///< its largest one, MPa
  double skew = 0.02;      ///< unsymmetric part of a tangent relative to its symmetric part
  double weight = 4;       ///< augmentation W = min(weight mu_e, K) / V_e
  double stress = 10;      ///< size of stresses, MPa
  double resistance = 0;   ///< kappa / mean mu_e, solver/point_volumes.hpp
  bool mixed = true;       ///< else the displacement element, K inside A
  int points = 4;          ///< of an element
  bool straight = false;   ///< of solver/reference_element.hpp
  int idle_ranks = 0;      ///< ranks, the last ones, that own nothing (one rank is left)
  std::uint64_t seed = 1;
};

/// System of one increment of plane-strain compression: z faces displaced, y faces and x0 fixed in
/// their normal direction, x1 free. Nodes are numbered along the lattice of half cells.
struct LinearProblem {
  std::unique_ptr<solver::Distribution> mesh;
  std::unique_ptr<solver::NodeExchange> exchange;
  solver::LinearLayout layout;
  // As in LinearBlocks; x and mean_stress likewise.
  std::vector<double> x, stress, tangent, mean_stress, reference, departure, scale, C, W, schur;
  double bulk = 0, kappa = 0;  ///< MPa; K of either element
  solver::VecHandle ru, rp, du, dp;

  solver::LinearBlocks blocks() const;
  /// [A B^T; B -C] [u; p], from the elements' matrices: the plain twin of the solver's operator.
  /// u: [local_nodes][3], ghosts filled; yu: likewise, complete on owned nodes, zero at Dirichlet
  /// dofs.
  void apply_plain(const std::vector<double>& u, const std::vector<double>& p,
                   std::vector<double>& yu, std::vector<double>& yp) const;
  /// Matrix of an element, Dirichlet rows and columns included, and dV/du.
  void element(int e, solver::ElementMatrix& matrix, solver::ElementForces& b) const;
  /// ||b - M x|| / ||b|| of the system as it stands (not augmented), u and p rows apart, larger.
  double relative_residual() const;
  /// [nodes][3] of the whole mesh, then pressures of all elements, on every rank.
  std::vector<double> solution() const;
};

/// Collective over `comm`; the same system for any number of ranks, but for rounding.
LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& options);

/// The same on a mesh of a unit cube, known to every rank, with a tangent for each of its grains.
LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& options,
                                  const mesh::Mesh& cube);

}  // namespace polyslip::test
