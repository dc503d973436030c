#include "solver/reference_element.hpp"

#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::solver {

const PointTable& point_table() {
  static const PointTable table = [] {
    PointTable t{};
    const auto rule = mesh::tet_quadrature_4();
    for (int q = 0; q < element_points; ++q) {
      const auto g = mesh::tet10_gradients(rule[q].xi);
      t.weights[q] = rule[q].weight;
      for (int L = 0; L < 3; ++L)
        for (int a = 0; a < element_nodes; ++a) t.gradients[L][a][q] = g[a][L];
    }
    return t;
  }();
  return table;
}

}  // namespace polyslip::solver
