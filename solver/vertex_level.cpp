#include "solver/vertex_level.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

template <class T>
std::vector<T> gather_all(MPI_Comm comm, const std::vector<T>& mine, MPI_Datatype type) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<int> counts(ranks), offsets(ranks + 1, 0);
  const int count = static_cast<int>(mine.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (int r = 0; r < ranks; ++r) offsets[r + 1] = offsets[r] + counts[r];
  std::vector<T> all(offsets[ranks]);
  MPI_Allgatherv(mine.data(), count, type, all.data(), counts.data(), offsets.data(), type, comm);
  return all;
}

void check_sizes(const LinearLayout& layout) {
  const auto n = static_cast<std::size_t>(layout.local_nodes);
  if (layout.parents.size() != n || layout.is_corner.size() != n ||
      layout.coordinates.size() != 3 * n || layout.constrained.size() != 3 * n) {
    throw core::InternalError(
        fmt::format("LinearLayout: {} nodes, but {} parents, {} corner flags, {} coordinates, {} "
                    "constraints",
                    n, layout.parents.size(), layout.is_corner.size(), layout.coordinates.size(),
                    layout.constrained.size()));
  }
}

}  // namespace

VertexLevel::VertexLevel(const LinearLayout& layout)
    : comm_(layout.comm), local_nodes_(layout.local_nodes) {
  check_sizes(layout);
  MPI_Comm_size(comm_, &ranks_);
  MPI_Exscan(&local_nodes_, &first_, 1, MPIU_INT, MPI_SUM, comm_);
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  if (rank == 0) first_ = 0;

  std::vector<PetscInt> mine;
  for (const auto& p : layout.parents) mine.insert(mine.end(), {p[0], p[1]});
  const std::vector<PetscInt> parents = gather_all(comm_, mine, MPIU_INT);
  const auto corner = gather_all(comm_, layout.is_corner, MPI_UINT8_T);
  const auto fixed = gather_all(comm_, layout.constrained, MPI_UINT8_T);
  const auto x = gather_all(comm_, layout.coordinates, MPI_DOUBLE);

  std::vector<PetscInt> vertex(corner.size(), -1);
  for (std::size_t i = 0; i < corner.size(); ++i) {
    if (!corner[i]) continue;
    vertex[i] = nodes_++;
    constrained_.insert(constrained_.end(), fixed.begin() + 3 * i, fixed.begin() + 3 * i + 3);
    coordinates_.insert(coordinates_.end(), x.begin() + 3 * i, x.begin() + 3 * i + 3);
  }
  parents_.resize(corner.size());
  for (std::size_t i = 0; i < corner.size(); ++i) {
    for (int e = 0; e < 2; ++e) {
      const PetscInt p = parents[2 * i + e];
      if (p < 0 || p >= static_cast<PetscInt>(corner.size()) || !corner[p]) {
        throw core::InternalError(
            fmt::format("LinearLayout: parent {} of node {} is no corner", p, i));
      }
      parents_[i].vertex[e] = vertex[p];
      for (int a = 0; a < 3; ++a) {
        if (!fixed[3 * i + a] && !fixed[3 * p + a]) parents_[i].mask[e] |= 1u << a;
      }
    }
  }
}

void VertexLevel::prolong_add(const double* coarse, double* fine) const {
  for (PetscInt i = 0; i < local_nodes_; ++i) {
    const Parents& p = parents_[first_ + i];
    for (int e = 0; e < 2; ++e) {
      for (int a = 0; a < 3; ++a) {
        if (p.mask[e] >> a & 1) fine[3 * i + a] += 0.5 * coarse[3 * p.vertex[e] + a];
      }
    }
  }
}

void VertexLevel::restrict_to(const double* fine, double* coarse) const {
  std::fill_n(coarse, 3 * nodes_, 0.0);
  for (PetscInt i = 0; i < local_nodes_; ++i) {
    const Parents& p = parents_[first_ + i];
    for (int e = 0; e < 2; ++e) {
      for (int a = 0; a < 3; ++a) {
        if (p.mask[e] >> a & 1) coarse[3 * p.vertex[e] + a] += 0.5 * fine[3 * i + a];
      }
    }
  }
  if (ranks_ > 1) {
    MPI_Allreduce(MPI_IN_PLACE, coarse, static_cast<int>(3 * nodes_), MPI_DOUBLE, MPI_SUM, comm_);
  }
}

/// Calls visit(i, blocks, first, last, column) for each row of the diagonal, then of the
/// off-diagonal part; `column` turns the part's block columns into global nodes.
template <class Visit>
void VertexLevel::for_each_part(Mat A, Visit visit) const {
  PetscBool sequential = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), MATSEQBAIJ, &sequential));
  std::array<Mat, 2> parts{A, nullptr};
  const PetscInt* ghosts = nullptr;
  if (!sequential) check(MatMPIBAIJGetSeqBAIJ(A, &parts[0], &parts[1], &ghosts));
  for (int part = 0; part < (sequential ? 1 : 2); ++part) {
    PetscInt rows = 0;
    RowBlocks blocks;
    PetscBool done = PETSC_FALSE;
    PetscScalar* values = nullptr;
    check(MatGetRowIJ(parts[part], 0, PETSC_FALSE, PETSC_TRUE, &rows, &blocks.start, &blocks.column,
                      &done));
    if (!done || rows != local_nodes_) {
      throw core::InternalError(
          fmt::format("VertexLevel: {} block rows where {} are expected", rows, local_nodes_));
    }
    check(MatSeqBAIJGetArray(parts[part], &values));
    blocks.values = values;
    visit(blocks, [&](PetscInt c) { return part == 0 ? first_ + c : ghosts[c]; });
    check(MatSeqBAIJRestoreArray(parts[part], &values));
    check(MatRestoreRowIJ(parts[part], 0, PETSC_FALSE, PETSC_TRUE, &rows, &blocks.start,
                          &blocks.column, &done));
  }
}

void VertexLevel::build_structure(Mat A) {
  std::vector<std::vector<PetscInt>> rows(nodes_);
  for_each_part(A, [&](const RowBlocks& blocks, auto column) {
    for (PetscInt i = 0; i < local_nodes_; ++i) {
      for (const PetscInt I : parents_[first_ + i].vertex) {
        for (PetscInt k = blocks.start[i]; k < blocks.start[i + 1]; ++k) {
          const auto& J = parents_[column(blocks.column[k])].vertex;
          rows[I].insert(rows[I].end(), J.begin(), J.end());
        }
        if (rows[I].size() > 512) {  // keep the lists short while they grow
          std::sort(rows[I].begin(), rows[I].end());
          rows[I].erase(std::unique(rows[I].begin(), rows[I].end()), rows[I].end());
        }
      }
    }
  });
  row_start_.assign(nodes_ + 1, 0);
  for (PetscInt I = 0; I < nodes_; ++I) {
    std::sort(rows[I].begin(), rows[I].end());
    rows[I].erase(std::unique(rows[I].begin(), rows[I].end()), rows[I].end());
    row_start_[I + 1] = row_start_[I] + static_cast<PetscInt>(rows[I].size());
  }
  build_slots(A, rows);
  build_pattern(rows);
}

void VertexLevel::build_slots(Mat A, const std::vector<std::vector<PetscInt>>& rows) {
  slots_.clear();
  for_each_part(A, [&](const RowBlocks& blocks, auto column) {
    for (PetscInt i = 0; i < local_nodes_; ++i) {
      const auto& I = parents_[first_ + i].vertex;
      for (PetscInt k = blocks.start[i]; k < blocks.start[i + 1]; ++k) {
        const auto& J = parents_[column(blocks.column[k])].vertex;
        auto& slot = slots_.emplace_back();
        for (int s = 0; s < 4; ++s) {
          const auto& row = rows[I[s / 2]];
          slot[s] = static_cast<std::uint16_t>(std::lower_bound(row.begin(), row.end(), J[s % 2]) -
                                               row.begin());
        }
      }
    }
  });
}

void VertexLevel::build_pattern(const std::vector<std::vector<PetscInt>>& rows) {
  std::vector<std::int64_t> keys;
  for (PetscInt I = 0; I < nodes_; ++I) {
    for (const PetscInt J : rows[I]) keys.push_back(std::int64_t{I} * nodes_ + J);
  }
  block_counts_.resize(ranks_);
  block_offsets_.assign(ranks_, 0);
  const int mine = static_cast<int>(9 * keys.size());
  MPI_Allgather(&mine, 1, MPI_INT, block_counts_.data(), 1, MPI_INT, comm_);
  for (int r = 1; r < ranks_; ++r) block_offsets_[r] = block_offsets_[r - 1] + block_counts_[r - 1];
  const std::vector<std::int64_t> all = gather_all(comm_, keys, MPI_INT64_T);
  keys = all;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());

  targets_.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    targets_[k] =
        static_cast<PetscInt>(std::lower_bound(keys.begin(), keys.end(), all[k]) - keys.begin());
  }
  pattern_start_.assign(nodes_ + 1, 0);
  pattern_column_.resize(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k) {
    ++pattern_start_[keys[k] / nodes_ + 1];
    pattern_column_[k] = static_cast<PetscInt>(keys[k] % nodes_);
  }
  for (PetscInt I = 0; I < nodes_; ++I) pattern_start_[I + 1] += pattern_start_[I];

  std::vector<PetscInt> start{0}, column;
  for (PetscInt I = 0; I < nodes_; ++I) {
    for (int a = 0; a < 3; ++a) {
      for (PetscInt k = pattern_start_[I]; k < pattern_start_[I + 1]; ++k) {
        for (int b = 0; b < 3; ++b) column.push_back(3 * pattern_column_[k] + b);
      }
      start.push_back(static_cast<PetscInt>(column.size()));
    }
  }
  check(MatCreate(PETSC_COMM_SELF, matrix_.out()));
  check(MatSetSizes(matrix_.get(), 3 * nodes_, 3 * nodes_, 3 * nodes_, 3 * nodes_));
  check(MatSetBlockSize(matrix_.get(), 3));
  check(MatSetType(matrix_.get(), MATSEQAIJ));
  check(MatSeqAIJSetPreallocationCSR(matrix_.get(), start.data(), column.data(), nullptr));
}

void VertexLevel::add_products(Mat A, std::vector<double>& products) const {
  auto slot = slots_.begin();
  for_each_part(A, [&](const RowBlocks& blocks, auto column) {
    for (PetscInt i = 0; i < local_nodes_; ++i) {
      const Parents& I = parents_[first_ + i];
      for (PetscInt k = blocks.start[i]; k < blocks.start[i + 1]; ++k, ++slot) {
        const Parents& J = parents_[column(blocks.column[k])];
        const double* block = blocks.values + 9 * k;
        for (int s = 0; s < 4; ++s) {
          double* out = &products[9 * (row_start_[I.vertex[s / 2]] + (*slot)[s])];
          const unsigned in_row = I.mask[s / 2], in_column = J.mask[s % 2];
          for (int b = 0; b < 3; ++b) {
            for (int a = 0; a < 3; ++a) {
              const bool takes_part = (in_row >> a & 1) && (in_column >> b & 1);
              out[3 * a + b] += takes_part ? 0.25 * block[3 * b + a] : 0.0;
            }
          }
        }
      }
    }
  });
}

void VertexLevel::fill(const std::vector<double>& products) {
  std::vector<double> sum(9 * pattern_column_.size(), 0.0);
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    for (int c = 0; c < 9; ++c) sum[9 * targets_[k] + c] += products[9 * k + c];
  }
  PetscScalar* values = nullptr;
  check(MatSeqAIJGetArrayWrite(matrix_.get(), &values));
  PetscScalar* out = values;
  for (PetscInt I = 0; I < nodes_; ++I) {
    for (int a = 0; a < 3; ++a) {
      for (PetscInt k = pattern_start_[I]; k < pattern_start_[I + 1]; ++k) {
        for (int b = 0; b < 3; ++b) *out++ = sum[9 * k + 3 * a + b];
        if (pattern_column_[k] == I && constrained_[3 * I + a]) *(out - 3 + a) = 1;
      }
    }
  }
  check(MatSeqAIJRestoreArrayWrite(matrix_.get(), &values));
  check(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY));
}

Mat VertexLevel::galerkin(Mat A) {
  if (!matrix_) build_structure(A);
  std::vector<double> products(9 * static_cast<std::size_t>(row_start_[nodes_]), 0.0);
  add_products(A, products);
  if (ranks_ > 1) {
    std::vector<double> all(9 * targets_.size());
    MPI_Allgatherv(products.data(), static_cast<int>(products.size()), MPI_DOUBLE, all.data(),
                   block_counts_.data(), block_offsets_.data(), MPI_DOUBLE, comm_);
    products = std::move(all);
  }
  fill(products);
  return matrix_.get();
}

}  // namespace polyslip::solver
