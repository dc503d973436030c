#include "solver/vertex_level.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

void check_sizes(const LinearLayout& layout) {
  const std::size_t owned = layout.displacements();
  const std::size_t all = 3 * static_cast<std::size_t>(layout.local->local_nodes);
  if (layout.coordinates.size() != owned || layout.constrained.size() != all)
    throw core::InternalError(
        fmt::format("LinearLayout: {} nodes, {} of them owned, but {} constraints, {} coordinates",
                    all / 3, owned / 3, layout.constrained.size(), layout.coordinates.size()));
}

/// Numbers the corner nodes, owned ones first as the nodes are; -1 for a mid node.
std::vector<int> number_corners(const LocalMesh& local) {
  std::vector<int> number(static_cast<std::size_t>(local.local_nodes), -1);
  for (const auto& e : local.elements)
    for (int a = 0; a < 4; ++a) number[e[a]] = 0;
  int next = 0;
  for (int& n : number)
    if (n == 0) n = next++;
  return number;
}

}  // namespace

VertexLevel::VertexLevel(const LinearLayout& layout) : layout_(layout) {
  check_sizes(layout);
  const LocalMesh& local = *layout.local;
  const std::vector<int> number = number_corners(local);
  NodeGraph graph;
  graph.comm = local.comm;
  for (int n = 0; n < local.local_nodes; ++n) {
    if (number[n] < 0) continue;
    ++graph.local_nodes;
    if (local.owned(n)) ++graph.owned_nodes;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t dof = 3 * static_cast<std::size_t>(n) + i;
      constrained_.push_back(layout.constrained[dof]);
      if (local.owned(n)) coordinates_.push_back(layout.coordinates[dof]);
    }
  }
  PetscInt first = 0;
  const PetscInt owned = graph.owned_nodes;
  MPI_Exscan(&owned, &first, 1, MPIU_INT, MPI_SUM, local.comm);
  MPI_Allreduce(&owned, &graph.global_nodes, 1, MPIU_INT, MPI_SUM, local.comm);
  exchange_ = std::make_unique<NodeExchange>(*layout.exchange, number);
  graph.node_global.resize(static_cast<std::size_t>(graph.local_nodes));
  for (int v = 0; v < graph.owned_nodes; ++v) graph.node_global[v] = first + v;
  exchange_->update_ghosts(graph.node_global, 1);

  parents_.resize(static_cast<std::size_t>(local.owned_nodes));
  for (const auto& e : local.elements) {
    for (int a = 0; a < 4; ++a) {
      graph.elements.push_back(number[e[a]]);
      if (local.owned(e[a])) parents_[e[a]] = {number[e[a]], number[e[a]]};
    }
    for (int m = 0; m < 6; ++m) {
      const auto [a, b] = mesh::tetrahedron_edges[m];
      if (local.owned(e[4 + m])) parents_[e[4 + m]] = {number[e[a]], number[e[b]]};
    }
  }
  pattern_ = std::make_unique<BlockPattern>(std::move(graph), *exchange_);
  matrix_ = pattern_->create();
  work_.resize(constrained_.size());
}

void VertexLevel::prolong(const double* coarse, float* fine) {
  const std::size_t n = coordinates_.size();
  std::copy_n(coarse, n, work_.begin());
  exchange_->update_ghosts(work_, 3);
  for (std::size_t i = 0; i < work_.size(); ++i)
    if (constrained_[i]) work_[i] = 0;
  for (std::size_t k = 0; k < parents_.size(); ++k) {
    const double* a = &work_[3 * static_cast<std::size_t>(parents_[k][0])];
    const double* b = &work_[3 * static_cast<std::size_t>(parents_[k][1])];
    for (std::size_t i = 0; i < 3; ++i)
      fine[3 * k + i] =
          layout_.constrained[3 * k + i] ? 0.0f : static_cast<float>(0.5 * (a[i] + b[i]));
  }
}

void VertexLevel::restrict_to(const float* fine, double* coarse) {
  std::fill(work_.begin(), work_.end(), 0.0);
  for (std::size_t k = 0; k < parents_.size(); ++k)
    for (const int vertex : parents_[k])
      for (std::size_t i = 0; i < 3; ++i)
        work_[3 * static_cast<std::size_t>(vertex) + i] +=
            0.5 * static_cast<double>(fine[3 * k + i]);
  exchange_->add_ghosts(work_, 3);
  for (std::size_t i = 0; i < coordinates_.size(); ++i) coarse[i] = constrained_[i] ? 0 : work_[i];
}

Mat VertexLevel::galerkin(const FineLevel& fine) {
  const Stage stage(layout_.exchange->profile(), "vertex matrix");
  values_.assign(pattern_->value_count(), 0.0);
  fine.vertex_blocks([&](int element, const FineLevel::VertexBlock& block) {
    double matrix[12][12];
    double keep[12];
    const int* vertices = &pattern_->graph().elements[4 * static_cast<std::size_t>(element)];
    for (int k = 0; k < 12; ++k)
      keep[k] = constrained_[3 * static_cast<std::size_t>(vertices[k / 3]) + k % 3] ? 0 : 1;
    for (int r = 0; r < 12; ++r)
      for (int c = 0; c < 12; ++c)
        matrix[r][c] = keep[r] * keep[c] * static_cast<double>(block[r / 3][r % 3][c / 3][c % 3]);
    pattern_->add(element, &matrix[0][0], values_);
  });
  pattern_->finish(constrained_, values_);
  pattern_->copy(values_, matrix_.get());
  values_.clear();
  values_.shrink_to_fit();
  return matrix_.get();
}

}  // namespace polyslip::solver
