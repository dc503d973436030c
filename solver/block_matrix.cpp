#include "solver/block_matrix.hpp"

#include <algorithm>
#include <numeric>

#include "core/error.hpp"
#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

void sort_unique(std::vector<PetscInt>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

/// AIJ matrix from the CSR arrays of this rank's rows (global columns, ascending).
MatHandle create_aij(MPI_Comm comm, PetscInt rows, PetscInt columns, PetscInt all_columns,
                     const std::vector<PetscInt>& start, const std::vector<PetscInt>& column,
                     PetscInt row_block, PetscInt column_block) {
  MatHandle m;
  check(MatCreate(comm, m.out()));
  check(MatSetSizes(m.get(), rows, columns, PETSC_DETERMINE, all_columns));
  check(MatSetType(m.get(), MATAIJ));
  check(MatSetBlockSizes(m.get(), row_block, column_block));
  check(MatSeqAIJSetPreallocationCSR(m.get(), start.data(), column.data(), nullptr));
  check(MatMPIAIJSetPreallocationCSR(m.get(), start.data(), column.data(), nullptr));
  check(MatSetOption(m.get(), MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  return m;
}

void copy_values(const double* values, std::size_t count, Mat matrix, MPI_Comm comm) {
  if (size_of(comm) > 1) {
    check(MatUpdateMPIAIJWithArray(matrix, values));
    return;
  }
  PetscScalar* array = nullptr;
  check(MatSeqAIJGetArrayWrite(matrix, &array));
  std::copy(values, values + count, array);
  check(MatSeqAIJRestoreArrayWrite(matrix, &array));
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

}  // namespace

BlockPattern::BlockPattern(const LocalMesh& local, const NodeExchange& exchange)
    : local_(local), exchange_(exchange) {
  std::vector<std::vector<PetscInt>> rows(local.local_nodes);
  for (const auto& e : local.elements)
    for (int a : e)
      for (int b : e) rows[a].push_back(local.node_global[b]);
  for (auto& row : rows) sort_unique(row);

  // Ghost rows to their owners: length of each row, then its columns.
  const auto& ranks = exchange.neighbours();
  std::vector<std::vector<PetscInt>> out(ranks.size());
  for (std::size_t k = 0; k < ranks.size(); ++k)
    for (int ghost : exchange.ghosts_of()[k]) {
      out[k].push_back(static_cast<PetscInt>(rows[ghost].size()));
      out[k].insert(out[k].end(), rows[ghost].begin(), rows[ghost].end());
    }
  const auto in = solver::exchange(local.comm, ranks, out);
  const auto for_each_received = [&](const auto& visit) {
    for (std::size_t k = 0; k < ranks.size(); ++k) {
      std::size_t at = 0;
      for (int node : exchange.seen_by()[k]) {
        const auto length = static_cast<std::size_t>(in[k][at++]);
        for (std::size_t j = 0; j < length; ++j) visit(k, node, in[k][at++]);
      }
    }
  };
  for_each_received([&](std::size_t, int node, PetscInt column) { rows[node].push_back(column); });
  for (int i = 0; i < local.owned_nodes; ++i) sort_unique(rows[i]);

  row_start_.assign(1, 0);
  for (const auto& row : rows) {
    row_start_.push_back(row_start_.back() + static_cast<std::int64_t>(row.size()));
    columns_.insert(columns_.end(), row.begin(), row.end());
  }
  received_.resize(ranks.size());
  received_stride_.resize(ranks.size());
  for_each_received([&](std::size_t k, int node, PetscInt column) {
    received_[k].push_back(slot(node, column));
    received_stride_[k].push_back(stride(node));
  });
  for (int i = 0; i < local.owned_nodes; ++i) diagonal_.push_back(slot(i, local.node_global[i]));
  slots_.reserve(local.elements.size() * 100);
  for (const auto& e : local.elements)
    for (int a : e)
      for (int b : e) slots_.push_back(slot(a, local.node_global[b]));
}

std::int64_t BlockPattern::slot(int row, PetscInt column) const {
  const auto begin = columns_.begin() + row_start_[row],
             end = columns_.begin() + row_start_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column) throw core::InternalError("BlockPattern: no such block");
  return 9 * row_start_[row] + 3 * (found - begin);
}

void BlockPattern::add(int element, const ElementMatrix& matrix,
                       std::vector<double>& values) const {
  const std::int64_t* slots = &slots_[static_cast<std::size_t>(element) * 100];
  for (int a = 0; a < element_nodes; ++a) {
    const int step = stride(local_.elements[element][a]);
    for (int b = 0; b < element_nodes; ++b) {
      double* block = values.data() + slots[10 * a + b];
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) block[i * step + k] += matrix[a][i][b][k];
    }
  }
}

void BlockPattern::finish(const std::vector<std::uint8_t>& constrained,
                          std::vector<double>& values) const {
  const auto& ranks = exchange_.neighbours();
  std::vector<std::vector<double>> out(ranks.size());
  for (std::size_t k = 0; k < ranks.size(); ++k)
    for (int ghost : exchange_.ghosts_of()[k]) {
      const int step = stride(ghost);
      for (int j = 0; j < step; j += 3) {
        const double* block = values.data() + 9 * row_start_[ghost] + j;
        for (int i = 0; i < 3; ++i)
          out[k].insert(out[k].end(), block + i * step, block + i * step + 3);
      }
    }
  const auto in = solver::exchange(local_.comm, ranks, out);
  for (std::size_t k = 0; k < ranks.size(); ++k)
    for (std::size_t n = 0; n < received_[k].size(); ++n) {
      double* block = values.data() + received_[k][n];
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
          block[i * received_stride_[k][n] + c] += in[k][9 * n + 3 * i + c];
    }
  for (int node = 0; node < local_.owned_nodes; ++node)
    for (int i = 0; i < 3; ++i)
      if (constrained[3 * static_cast<std::size_t>(node) + i])
        values[diagonal_[node] + static_cast<std::int64_t>(i) * stride(node) + i] = 1;
}

MatHandle BlockPattern::create() const {
  std::vector<PetscInt> start{0}, column;
  column.reserve(9 * static_cast<std::size_t>(row_start_[local_.owned_nodes]));
  for (int node = 0; node < local_.owned_nodes; ++node)
    for (int i = 0; i < 3; ++i) {
      for (std::int64_t j = row_start_[node]; j < row_start_[node + 1]; ++j)
        for (PetscInt k = 0; k < 3; ++k) column.push_back(3 * columns_[j] + k);
      start.push_back(static_cast<PetscInt>(column.size()));
    }
  const PetscInt rows = 3 * local_.owned_nodes;
  return create_aij(local_.comm, rows, rows, 3 * local_.global_nodes, start, column, 3, 3);
}

void BlockPattern::copy(const std::vector<double>& values, Mat matrix) const {
  const std::size_t owned = 9 * static_cast<std::size_t>(row_start_[local_.owned_nodes]);
  copy_values(values.data(), owned, matrix, local_.comm);
}

VolumeGradientMatrix::VolumeGradientMatrix(const LocalMesh& local) : local_(local) {
  for (const auto& e : local.elements) {
    std::array<int, element_nodes> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return local.node_global[e[a]] < local.node_global[e[b]]; });
    const std::size_t first = position_.size();
    position_.resize(first + 30);
    for (int n = 0; n < element_nodes; ++n)
      for (int i = 0; i < 3; ++i) {
        position_[first + 3 * static_cast<std::size_t>(order[n]) + i] =
            static_cast<std::uint8_t>(3 * n + i);
        columns_.push_back(3 * local.node_global[e[order[n]]] + i);
      }
  }
}

void VolumeGradientMatrix::set(int element, const ElementForces& b,
                               std::vector<double>& values) const {
  const std::size_t first = 30 * static_cast<std::size_t>(element);
  for (std::size_t a = 0; a < element_nodes; ++a)
    for (std::size_t i = 0; i < 3; ++i) values[first + position_[first + 3 * a + i]] = b[a][i];
}

MatHandle VolumeGradientMatrix::create() const {
  std::vector<PetscInt> start(local_.elements.size() + 1);
  for (std::size_t e = 0; e < start.size(); ++e) start[e] = static_cast<PetscInt>(30 * e);
  return create_aij(local_.comm, static_cast<PetscInt>(local_.elements.size()),
                    3 * local_.owned_nodes, 3 * local_.global_nodes, start, columns_, 1, 3);
}

void VolumeGradientMatrix::copy(const std::vector<double>& values, Mat matrix) const {
  copy_values(values.data(), value_count(), matrix, local_.comm);
}

}  // namespace polyslip::solver
