#pragma once
// Sparse matrices of 3 x 3 node blocks: pattern from the elements, sums in a fixed order (element
// by element, then neighbour by neighbour), so that the same ranks give the same bits.

#include <cstdint>
#include <vector>

#include "solver/element.hpp"
#include "solver/partition.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

/// Pattern of the node-node matrix: rows of owned nodes, complete, then rows of ghosts as far as
/// this rank's elements know them. The values of block (row, j-th column) start at
/// 9 row_start[row] + 3 j and step by 3 (row length): a row of owned nodes is a CSR row of scalars.
class BlockPattern {
 public:
  /// Collective.
  BlockPattern(const LocalMesh& local, const NodeExchange& exchange);

  /// Doubles that `add` and `finish` work on.
  std::size_t value_count() const { return 9 * static_cast<std::size_t>(row_start_.back()); }
  /// Adds an element's matrix.
  void add(int element, const ElementMatrix& matrix, std::vector<double>& values) const;
  /// Brings the ghosts' rows to their owners and puts 1 on the diagonal of constrained dofs, whose
  /// rows and columns the elements have left at zero. constrained: [local_nodes][3]. Collective.
  void finish(const std::vector<std::uint8_t>& constrained, std::vector<double>& values) const;

  /// A matrix of type AIJ, block size 3, with this pattern; its values are then `copy`'s.
  MatHandle create() const;
  void copy(const std::vector<double>& values, Mat matrix) const;

 private:
  const LocalMesh& local_;
  const NodeExchange& exchange_;
  std::vector<std::int64_t> row_start_;              // [local_nodes + 1] in blocks
  std::vector<PetscInt> columns_;                    // [blocks] global nodes, ascending in a row
  std::vector<std::int64_t> slots_;                  // [elements][10][10] first value of each block
  std::vector<std::int64_t> diagonal_;               // [owned_nodes] first value
  std::vector<std::vector<std::int64_t>> received_;  // [neighbours][blocks] first value
  std::vector<std::vector<PetscInt>> received_stride_;

  int stride(int row) const { return 3 * static_cast<int>(row_start_[row + 1] - row_start_[row]); }
  std::int64_t slot(int row, PetscInt column) const;
};

/// B of the mixed element: a row b_e for each element.
class VolumeGradientMatrix {
 public:
  explicit VolumeGradientMatrix(const LocalMesh& local);

  std::size_t value_count() const { return position_.size(); }
  void set(int element, const ElementForces& b, std::vector<double>& values) const;
  MatHandle create() const;
  void copy(const std::vector<double>& values, Mat matrix) const;

 private:
  const LocalMesh& local_;
  std::vector<std::uint8_t> position_;  // [elements][30] rank of dof 3 a + i within its row
  std::vector<PetscInt> columns_;
};

}  // namespace polyslip::solver
