#pragma once
// The vertex level below the quadratic displacements: prolongation (a mid node is the mean of its
// edge's ends), its transpose and the Galerkin product P^T A P. The vertex level is held whole on
// every rank, sums over ranks are taken in the order of the ranks: the same bits each time.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/linear_blocks.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

class VertexLevel {
 public:
  /// Collective. Throws core::InternalError for a layout whose sizes or parents are inconsistent.
  explicit VertexLevel(const LinearLayout& layout);

  PetscInt nodes() const { return nodes_; }
  /// [nodes][3]
  const std::vector<double>& coordinates() const { return coordinates_; }

  /// fine += P coarse. coarse: [nodes][3], the same on every rank; fine: this rank's [nodes][3].
  void prolong_add(const double* coarse, double* fine) const;
  /// coarse = P^T fine, the same on every rank. Collective.
  void restrict_to(const double* fine, double* coarse) const;

  /// P^T A P with unit rows for constrained dofs, on every rank (SeqAIJ, block size 3). A: BAIJ of
  /// block size 3, whose structure is that of the first call. Collective.
  Mat galerkin(Mat A);

 private:
  struct Parents {
    std::array<PetscInt, 2> vertex{};    // vertex-level nodes, equal for a corner
    std::array<std::uint8_t, 2> mask{};  // bit a: dof a takes part
  };
  struct RowBlocks {  // of a sequential BAIJ matrix
    const PetscInt* start = nullptr;
    const PetscInt* column = nullptr;
    const double* values = nullptr;  // [blocks][3 x 3, by columns]
  };

  template <class Visit>
  void for_each_part(Mat A, Visit visit) const;
  void build_structure(Mat A);
  void build_pattern(const std::vector<std::vector<PetscInt>>& rows);
  void build_slots(Mat A, const std::vector<std::vector<PetscInt>>& rows);
  void add_products(Mat A, std::vector<double>& products) const;
  void fill(const std::vector<double>& products);

  MPI_Comm comm_;
  int ranks_ = 1;
  PetscInt first_ = 0;  // first global node of this rank
  PetscInt local_nodes_ = 0;
  PetscInt nodes_ = 0;
  std::vector<Parents> parents_;           // of every fine node, global numbers
  std::vector<std::uint8_t> constrained_;  // [nodes][3] of the vertex level
  std::vector<double> coordinates_;

  // Structure of the product: this rank's blocks (row by row), and where each rank's blocks go.
  std::vector<PetscInt> row_start_;                  // [nodes + 1] into this rank's blocks
  std::vector<std::array<std::uint16_t, 4>> slots_;  // per fine block: offsets in its two rows
  std::vector<int> block_counts_, block_offsets_;    // per rank
  std::vector<PetscInt> targets_;  // [blocks of all ranks] block of the assembled matrix
  std::vector<PetscInt> pattern_start_, pattern_column_;  // assembled, by blocks
  MatHandle matrix_;
};

}  // namespace polyslip::solver
