#pragma once
// Shape functions of the ten-node tetrahedron at its quadrature points, points innermost.

#include "solver/element.hpp"

namespace polyslip::solver {

struct PointTable {
  /// [direction][node][point] dN_a / dxi_L
  double gradients[3][element_nodes][element_points];
  double weights[element_points];  ///< they add up to 1/6
};
const PointTable& point_table();

}  // namespace polyslip::solver
