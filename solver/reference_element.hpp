#pragma once
// Shape functions of the ten-node tetrahedron at the points of a quadrature rule, and the functions
// that map its positions.

#include <array>

#include "material/crystal_law.hpp"

namespace polyslip::solver {

inline constexpr int element_nodes = 10;
inline constexpr int max_element_points = 15;
inline constexpr int max_point_blocks = (max_element_points - 1) / material::lanes + 1;
inline constexpr int max_element_slots = max_point_blocks * material::lanes;

/// The points of an element stand in whole blocks of the material's lanes. Lanes beyond the last
/// point repeat it with the weight zero: they are computed and count for nothing.
struct PointRule {
  int points = 0;  ///< 4, 8, 14 or 15
  int blocks = 0;  ///< points / material::lanes, rounded up
  int slots = 0;   ///< blocks * material::lanes: points and fillings
  /// [block][direction][node][lane] dN_a / dxi_L
  double gradients[max_point_blocks][3][element_nodes][material::lanes];
  double weights[max_point_blocks][material::lanes];  ///< they add up to 1/6
  /// Likewise of the functions that map the positions, x = sum_a M_a(xi) x_a: the shape functions,
  /// or those of the straight tetrahedron of the corners (zero for mid nodes).
  double mapping[max_point_blocks][3][element_nodes][material::lanes];
  /// The same point by point: [point][direction][node]
  double point_gradients[max_element_points][3][element_nodes];
  double point_mapping[max_element_points][3][element_nodes];
  bool straight = false;

  /// Index in an array [block][components][lane] of component c of the point q.
  static constexpr int at(int components, int c, int q) {
    return (q / material::lanes * components + c) * material::lanes + q % material::lanes;
  }
};

/// Of mesh::tet_quadrature(points); `straight`: on the tetrahedron of the corners. Throws
/// core::InternalError if there is no such rule.
const PointRule& point_rule(int points, bool straight = false);

}  // namespace polyslip::solver
