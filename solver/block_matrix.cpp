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

BlockPattern::BlockPattern(NodeGraph graph, const NodeExchange& exchange)
    : graph_(std::move(graph)), exchange_(exchange) {
  const NodeGraph& g = graph_;
  const auto n = static_cast<std::size_t>(g.element_nodes);
  std::vector<std::vector<PetscInt>> rows(g.local_nodes);
  const auto for_each_pair = [&](const auto& visit) {
    for (std::size_t e = 0; e < g.elements.size(); e += n)
      for (std::size_t a = e; a < e + n; ++a)
        for (std::size_t b = e; b < e + n; ++b) visit(g.elements[a], g.node_global[g.elements[b]]);
  };
  for_each_pair([&](int row, PetscInt column) { rows[row].push_back(column); });
  for (auto& row : rows) sort_unique(row);

  // Ghost rows to their owners: length of each row, then its columns.
  const auto& ranks = exchange.neighbours();
  std::vector<std::vector<PetscInt>> out(ranks.size());
  for (std::size_t k = 0; k < ranks.size(); ++k)
    for (int ghost : exchange.ghosts_of()[k]) {
      out[k].push_back(static_cast<PetscInt>(rows[ghost].size()));
      out[k].insert(out[k].end(), rows[ghost].begin(), rows[ghost].end());
    }
  const auto in = solver::exchange(g.comm, ranks, out);
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
  for (int i = 0; i < g.owned_nodes; ++i) sort_unique(rows[i]);

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
  for (int i = 0; i < g.owned_nodes; ++i) diagonal_.push_back(slot(i, g.node_global[i]));
  slots_.reserve(g.elements.size() * n);
  for_each_pair([&](int row, PetscInt column) { slots_.push_back(slot(row, column)); });
}

std::int64_t BlockPattern::slot(int row, PetscInt column) const {
  const auto begin = columns_.begin() + row_start_[row],
             end = columns_.begin() + row_start_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column) throw core::InternalError("BlockPattern: no such block");
  return 9 * row_start_[row] + 3 * (found - begin);
}

void BlockPattern::add(int element, const double* matrix, std::vector<double>& values) const {
  const auto n = static_cast<std::size_t>(graph_.element_nodes);
  const std::size_t first = static_cast<std::size_t>(element) * n;
  for (std::size_t a = 0; a < n; ++a) {
    const int step = stride(graph_.elements[first + a]);
    for (std::size_t b = 0; b < n; ++b) {
      double* block = values.data() + slots_[(first + a) * n + b];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          block[i * static_cast<std::size_t>(step) + k] += matrix[(3 * a + i) * 3 * n + 3 * b + k];
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
  const auto in = solver::exchange(graph_.comm, ranks, out);
  for (std::size_t k = 0; k < ranks.size(); ++k)
    for (std::size_t n = 0; n < received_[k].size(); ++n) {
      double* block = values.data() + received_[k][n];
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
          block[i * received_stride_[k][n] + c] += in[k][9 * n + 3 * i + c];
    }
  for (int node = 0; node < graph_.owned_nodes; ++node)
    for (int i = 0; i < 3; ++i)
      if (constrained[3 * static_cast<std::size_t>(node) + i])
        values[diagonal_[node] + static_cast<std::int64_t>(i) * stride(node) + i] = 1;
}

MatHandle BlockPattern::create() const {
  std::vector<PetscInt> start{0}, column;
  column.reserve(9 * static_cast<std::size_t>(row_start_[graph_.owned_nodes]));
  for (int node = 0; node < graph_.owned_nodes; ++node)
    for (int i = 0; i < 3; ++i) {
      for (std::int64_t j = row_start_[node]; j < row_start_[node + 1]; ++j)
        for (PetscInt k = 0; k < 3; ++k) column.push_back(3 * columns_[j] + k);
      start.push_back(static_cast<PetscInt>(column.size()));
    }
  const PetscInt rows = 3 * graph_.owned_nodes;
  return create_aij(graph_.comm, rows, rows, 3 * graph_.global_nodes, start, column, 3, 3);
}

void BlockPattern::copy(const std::vector<double>& values, Mat matrix) const {
  const std::size_t owned = 9 * static_cast<std::size_t>(row_start_[graph_.owned_nodes]);
  copy_values(values.data(), owned, matrix, graph_.comm);
}

}  // namespace polyslip::solver
