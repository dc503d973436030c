#pragma once
// The quadratic level of the multigrid, in single precision and without a matrix: the symmetric
// part of the augmented displacement block, sixteen elements at a time.

#include <array>
#include <memory>
#include <vector>

#include "solver/krylov_operator.hpp"
#include "solver/node_sum.hpp"

namespace polyslip::solver {

/// What the level keeps of a tangent: its symmetric part on the five deviatoric modes, the points'
/// volume resistance with s = 0, the augmentation (or K of the displacement element). What it
/// leaves out are terms of the order of the stress. On the points of element e, with E the modes of
/// the symmetric gradient of the displacements and d their divergences,
///   forces = sum_q w_q [E_q^T D5_q E_q u + (alpha_e d_q + beta_e mean(d)) d(div u)_q/du]
///   alpha = kappa + K (displacement element),  beta = W D^2 V - kappa
class FineLevel {
 public:
  explicit FineLevel(const LinearLayout& layout);

  /// Takes over tangents and geometry of an operator (copied).
  void set(const KrylovOperator& fine);

  /// Corner nodes' matrix of an element: P^T A P with P the mean of an edge's ends.
  using VertexBlock = std::array<std::array<std::array<std::array<float, 3>, 4>, 3>, 4>;
  /// Calls add(element, block) for every element, in ascending order.
  template <class Add>
  void vertex_blocks(const Add& add) const;

  /// y = A x on owned nodes; x: [local_nodes][3], ghosts are filled here, zero at Dirichlet dofs, y
  /// is made zero there. Collective.
  void apply(float* x, float* y);
  /// y = D^-1 x, D the 3 x 3 diagonal blocks (1 at Dirichlet dofs); owned nodes. May be in place.
  void apply_inverse_diagonal(const float* x, float* y) const;
  /// [owned_nodes][9] row by row.
  const std::vector<float>& inverse_diagonal() const { return inverse_diagonal_; }
  /// y = x + B^T c on owned nodes, Dirichlet dofs excepted. c: [elements]. Collective.
  void add_volume_forces(const std::vector<float>& c, const float* x, float* y);

  std::size_t dofs() const { return layout_.displacements(); }
  std::size_t local_dofs() const {
    return 3 * static_cast<std::size_t>(layout_.local->local_nodes);
  }
  const LinearLayout& layout() const { return layout_; }

 private:
  /// [group][point][25][lane]: volume, d xi_L / dx_l, upper triangle of w D5.
  static constexpr int point_values = 25;
  using Coefficients = std::array<std::vector<float>, 4>;

  /// [point][direction][node] dN_a / dxi_L
  using PointGradients = std::array<std::array<float, 10>, 3>;

  LinearLayout layout_;
  int element_points_;
  std::vector<PointGradients> gradients_;
  bool threaded_;
  int groups_;
  std::vector<int> nodes_;  // [groups][10][lane] 3 x local node; a filling element: the last one
  std::vector<float> points_;
  std::vector<float> alpha_, beta_, inverse_volume_, scale_;  // [groups][lane]
  std::vector<float> inverse_diagonal_;
  std::vector<float> y_;          // [local_nodes][3]
  std::unique_ptr<NodeSum> sum_;  // with threads
  std::vector<float> forces_;     // [elements][30] with threads

  int lanes_of(int group) const;
  /// Coefficients of point q of a group's elements, [25][lane].
  const float* point(int group, int q) const;
  void set_element(const KrylovOperator& fine, int element);
  /// Of a block of the element's points: geometry [10][4], tangent [54][4].
  void set_points(int element, int block, const double* geometry, const double* tangent);
  void set_diagonal();
  void diagonal_of(int group, float* out) const;
  void vertex_group(int group, VertexBlock* out) const;
  void forces_of(int group, const float* x, float* f) const;
  void volume_forces_of(int group, const float* c, float* f) const;
  /// Calls forces(group, f[30][lane]) for each group and sums into y_, ghosts included.
  template <class Forces>
  void sum_groups(const Forces& forces);
};

template <class Add>
void FineLevel::vertex_blocks(const Add& add) const {
  std::vector<VertexBlock> blocks(16);
  for (int g = 0; g < groups_; ++g) {
    vertex_group(g, blocks.data());
    for (int lane = 0; lane < lanes_of(g); ++lane) add(16 * g + lane, blocks[lane]);
  }
}

}  // namespace polyslip::solver
