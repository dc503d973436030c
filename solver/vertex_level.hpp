#pragma once
// The vertex level below the quadratic displacements: prolongation (a mid node is the mean of its
// edge's ends), its transpose and the Galerkin product P^T A P, distributed like the nodes. Sums
// over ranks are taken in a fixed order.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/block_matrix.hpp"
#include "solver/fine_level.hpp"

namespace polyslip::solver {

class VertexLevel {
 public:
  /// Collective. Throws core::InternalError for a layout whose sizes do not fit.
  explicit VertexLevel(const LinearLayout& layout);

  int owned_vertices() const { return pattern_->graph().owned_nodes; }
  PetscInt global_vertices() const { return pattern_->graph().global_nodes; }
  /// [owned_vertices][3]
  const std::vector<double>& coordinates() const { return coordinates_; }

  /// fine = P coarse on owned nodes. coarse: [owned_vertices][3]; fine: [owned_nodes][3], zero at
  /// Dirichlet dofs. Collective.
  void prolong(const double* coarse, float* fine);
  /// coarse = P^T fine on owned vertices, zero at Dirichlet dofs. fine: zero there. Collective.
  void restrict_to(const float* fine, double* coarse);

  /// P^T A P with unit rows and columns for Dirichlet dofs (AIJ, block size 3). Collective.
  Mat galerkin(const FineLevel& fine);

 private:
  LinearLayout layout_;
  std::vector<std::array<int, 2>> parents_;  // [owned_nodes] local vertices, equal for a corner
  std::vector<std::uint8_t> constrained_;    // [local vertices][3]
  std::vector<double> coordinates_;
  std::unique_ptr<NodeExchange> exchange_;  // of the vertices
  std::unique_ptr<BlockPattern> pattern_;
  std::vector<double> work_;    // [local vertices][3]
  std::vector<double> values_;  // of the matrix
  MatHandle matrix_;
};

}  // namespace polyslip::solver
