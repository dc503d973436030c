#pragma once
// Quadrature rules of the unit tetrahedron (volume 1/6) with positive weights.

#include <array>
#include <cmath>

#include "core/types.hpp"

namespace polyslip::mesh {

struct QuadraturePoint {
  core::Vec3 xi;      ///< local coordinates (xi, eta, zeta)
  double weight = 0;  ///< weights of a rule add up to 1/6
};

namespace detail {
/// Point of barycentric coordinates l1, l2, l3 (l0 = 1 - l1 - l2 - l3).
inline QuadraturePoint at_barycentric(const std::array<double, 4>& l, double weight) {
  return {core::Vec3(l[1], l[2], l[3]), weight};
}
}  // namespace detail

/// Four points, degree 2 (P. C. Hammer and A. H. Stroud, 1956): permutations of (a, b, b, b) with
/// a = (5 + 3 sqrt 5)/20, b = (5 - sqrt 5)/20. Point i is the one near corner i.
inline std::array<QuadraturePoint, 4> tet_quadrature_4() {
  const double a = (5 + 3 * std::sqrt(5.0)) / 20, b = (5 - std::sqrt(5.0)) / 20;
  std::array<QuadraturePoint, 4> rule;
  for (int i = 0; i < 4; ++i) {
    std::array<double, 4> l{b, b, b, b};
    l[i] = a;
    rule[i] = detail::at_barycentric(l, 1.0 / 24);
  }
  return rule;
}

/// Fifteen points, degree 5 (P. Keast, Comput. Methods Appl. Mech. Eng. 55, 1986, rule 6): the
/// centroid, the face centres, (8, 1, 1, 1)/11 and (c, c, d, d) with c, d = (1 -+ sqrt(7/13))/4.
inline std::array<QuadraturePoint, 15> tet_quadrature_15() {
  std::array<QuadraturePoint, 15> rule;
  int n = 0;
  rule[n++] = detail::at_barycentric({0.25, 0.25, 0.25, 0.25}, 6544.0 / 36015 / 6);
  for (int i = 0; i < 4; ++i) {
    std::array<double, 4> l{1.0 / 3, 1.0 / 3, 1.0 / 3, 1.0 / 3};
    l[i] = 0;
    rule[n++] = detail::at_barycentric(l, 81.0 / 2240 / 6);
  }
  for (int i = 0; i < 4; ++i) {
    std::array<double, 4> l{1.0 / 11, 1.0 / 11, 1.0 / 11, 1.0 / 11};
    l[i] = 8.0 / 11;
    rule[n++] = detail::at_barycentric(l, 161051.0 / 2304960 / 6);
  }
  const double c = (1 - std::sqrt(7.0 / 13)) / 4, d = (1 + std::sqrt(7.0 / 13)) / 4;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      std::array<double, 4> l{d, d, d, d};
      l[i] = l[j] = c;
      rule[n++] = detail::at_barycentric(l, 338.0 / 5145 / 6);
    }
  return rule;
}

}  // namespace polyslip::mesh
