#include "solver/reference_element.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::solver {
namespace {

PointRule make_rule(int points) {
  constexpr int lanes = material::lanes;
  const auto quadrature = mesh::tet_quadrature(points);
  PointRule r{};
  r.points = points;
  r.blocks = (points - 1) / lanes + 1;
  r.slots = r.blocks * lanes;
  for (int slot = 0; slot < r.slots; ++slot) {
    const int q = std::min(slot, points - 1);
    const auto g = mesh::tet10_gradients(quadrature[q].xi);
    r.weights[slot / lanes][slot % lanes] = slot < points ? quadrature[q].weight : 0;
    for (int L = 0; L < 3; ++L)
      for (int a = 0; a < element_nodes; ++a)
        r.gradients[slot / lanes][L][a][slot % lanes] = r.point_gradients[q][L][a] = g[a][L];
  }
  return r;
}

}  // namespace

const PointRule& point_rule(int points) {
  static const auto rules = [] {
    std::array<PointRule, mesh::tet_quadrature_sizes.size()> made;
    std::transform(mesh::tet_quadrature_sizes.begin(), mesh::tet_quadrature_sizes.end(),
                   made.begin(), make_rule);
    return made;
  }();
  for (const PointRule& rule : rules)
    if (rule.points == points) return rule;
  throw core::InternalError("no quadrature rule of " + std::to_string(points) +
                            " points in a tetrahedron");
}

}  // namespace polyslip::solver
