#pragma once
// The augmented saddle-point operator of LinearSolver, element by element in double precision from
// the law's tangents: no matrix. Its plain twin, the assembled matrix of element_tangent, is in
// tests/unit/solver.

#include <array>
#include <memory>
#include <vector>

#include "solver/element.hpp"
#include "solver/linear_blocks.hpp"
#include "solver/node_sum.hpp"

namespace polyslip::solver {

class KrylovOperator {
 public:
  explicit KrylovOperator(const LinearLayout& layout);

  /// Takes the blocks (not copied) and the geometry of their positions.
  void set(const LinearBlocks& blocks);

  /// [yu; yp] = [A + B^T W B, B^T (1 - W C); B, -C] [u; p] on owned nodes; u is zero and yu is made
  /// zero at Dirichlet dofs. u, yu: [owned_nodes][3]; p, yp: [elements]. Collective.
  void apply(const double* u, const double* p, double* yu, double* yp);
  /// yu += B^T c on owned nodes, Dirichlet dofs excepted. c: [elements]. Collective.
  void add_volume_forces(const double* c, double* yu);

  const PointRule& rule() const { return rule_; }
  /// [elements][blocks][10][4]: volume w of the point, then d xi_L / dx_l at 1 + 3 L + l.
  const std::vector<double>& geometry() const { return geometry_; }
  const LinearBlocks& blocks() const { return blocks_; }

 private:
  LinearLayout layout_;
  const PointRule& rule_;
  LinearBlocks blocks_;
  bool threaded_;
  std::vector<double> geometry_;
  std::vector<double> u_, y_;     // [local_nodes][3]
  std::unique_ptr<NodeSum> sum_;  // with threads
  std::vector<double> forces_;    // [elements][30] with threads

  /// Calls `forces(element, f[30])` for each element and sums them into y_, ghosts included.
  template <class Forces>
  void sum_elements(const Forces& forces);
  /// `blocks`: of points, rule_.blocks, known when compiled.
  template <int blocks>
  void element(int e, const double* p, double* yp, double* f) const;
  template <int blocks>
  void volume_forces(int e, const double* c, double* f) const;
  /// Calls call(std::integral_constant<int, rule_.blocks>).
  template <class Call>
  void with_blocks(const Call& call) const;
};

}  // namespace polyslip::solver
