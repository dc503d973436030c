#pragma once
// Sparse matrices of 3 x 3 node blocks: pattern from the elements, sums in a fixed order (element
// by element, then neighbour by neighbour), so that the same ranks give the same bits.

#include <cstdint>
#include <vector>

#include "solver/partition.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

/// Nodes and elements as far as a matrix is concerned; see LocalMesh.
struct NodeGraph {
  MPI_Comm comm = MPI_COMM_SELF;
  int owned_nodes = 0, local_nodes = 0;
  PetscInt global_nodes = 0;
  std::vector<PetscInt> node_global;  ///< [local_nodes]
  int element_nodes = 4;
  std::vector<int> elements;  ///< [elements][element_nodes] local nodes
};

/// Pattern of the node-node matrix: rows of owned nodes, complete, then rows of ghosts as far as
/// this rank's elements know them. The values of block (row, j-th column) start at
/// 9 row_start[row] + 3 j and step by 3 (row length): a row of owned nodes is a CSR row of scalars.
class BlockPattern {
 public:
  /// Collective. exchange: of the graph's nodes.
  BlockPattern(NodeGraph graph, const NodeExchange& exchange);

  /// Doubles that `add` and `finish` work on.
  std::size_t value_count() const { return 9 * static_cast<std::size_t>(row_start_.back()); }
  /// Adds an element's matrix [element_nodes][3][element_nodes][3].
  void add(int element, const double* matrix, std::vector<double>& values) const;
  /// Brings the ghosts' rows to their owners and puts 1 on the diagonal of constrained dofs, whose
  /// rows and columns the elements have left at zero. constrained: [local_nodes][3]. Collective.
  void finish(const std::vector<std::uint8_t>& constrained, std::vector<double>& values) const;

  /// A matrix of type AIJ, block size 3, with this pattern; its values are then `copy`'s.
  MatHandle create() const;
  void copy(const std::vector<double>& values, Mat matrix) const;

  const NodeGraph& graph() const { return graph_; }

 private:
  NodeGraph graph_;
  const NodeExchange& exchange_;
  std::vector<std::int64_t> row_start_;              // [local_nodes + 1] in blocks
  std::vector<PetscInt> columns_;                    // [blocks] global nodes, ascending in a row
  std::vector<std::int64_t> slots_;                  // [elements][n][n] first value of each block
  std::vector<std::int64_t> diagonal_;               // [owned_nodes] first value
  std::vector<std::vector<std::int64_t>> received_;  // [neighbours][blocks] first value
  std::vector<std::vector<PetscInt>> received_stride_;

  int stride(int row) const { return 3 * static_cast<int>(row_start_[row + 1] - row_start_[row]); }
  std::int64_t slot(int row, PetscInt column) const;
};

}  // namespace polyslip::solver
