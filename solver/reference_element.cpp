#include "solver/reference_element.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::solver {
namespace {

PointRule make_rule(int points, bool straight) {
  constexpr int lanes = material::lanes;
  const auto quadrature = mesh::tet_quadrature(points);
  PointRule r{};
  r.points = points;
  r.straight = straight;
  r.blocks = (points - 1) / lanes + 1;
  r.slots = r.blocks * lanes;
  for (int slot = 0; slot < r.slots; ++slot) {
    const int q = std::min(slot, points - 1);
    const auto g = mesh::tet10_gradients(quadrature[q].xi);
    const auto& corners = mesh::barycentric_gradients;
    r.weights[slot / lanes][slot % lanes] = slot < points ? quadrature[q].weight : 0;
    for (int L = 0; L < 3; ++L)
      for (int a = 0; a < element_nodes; ++a) {
        const double m = !straight ? g[a][L] : a < 4 ? corners[a][L] : 0.0;
        r.gradients[slot / lanes][L][a][slot % lanes] = r.point_gradients[q][L][a] = g[a][L];
        r.mapping[slot / lanes][L][a][slot % lanes] = r.point_mapping[q][L][a] = m;
      }
  }
  return r;
}

}  // namespace

const PointRule& point_rule(int points, bool straight) {
  static const auto rules = [] {
    std::vector<PointRule> made;
    for (const int size : mesh::tet_quadrature_sizes)
      for (const bool kind : {false, true}) made.push_back(make_rule(size, kind));
    return made;
  }();
  for (const PointRule& rule : rules)
    if (rule.points == points && rule.straight == straight) return rule;
  throw core::InternalError("no quadrature rule of " + std::to_string(points) +
                            " points in a tetrahedron");
}

}  // namespace polyslip::solver
