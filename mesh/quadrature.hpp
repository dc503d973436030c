#pragma once
// Quadrature rules of the unit tetrahedron (volume 1/6) with positive weights.

#include <array>
#include <cmath>
#include <span>
#include <string>

#include "core/error.hpp"
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

/// The four permutations of (1 - 3a, a, a, a), the i-th one with 1 - 3a at corner i.
template <class Iterator>
Iterator put_corner_orbit(double a, double weight, Iterator at) {
  for (int i = 0; i < 4; ++i) {
    std::array<double, 4> l{a, a, a, a};
    l[i] = 1 - 3 * a;
    *at++ = at_barycentric(l, weight);
  }
  return at;
}

/// The six permutations of (c, c, 1/2 - c, 1/2 - c).
template <class Iterator>
Iterator put_edge_orbit(double c, double weight, Iterator at) {
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      std::array<double, 4> l{0.5 - c, 0.5 - c, 0.5 - c, 0.5 - c};
      l[i] = l[j] = c;
      *at++ = at_barycentric(l, weight);
    }
  return at;
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

/// Eight points, degree 3 (F. D. Witherden and P. E. Vincent, Comput. Math. Appl. 69, 2015): the
/// permutations of (1 - 3a, a, a, a) for an a near the faces and one near the corners.
inline std::array<QuadraturePoint, 8> tet_quadrature_8() {
  std::array<QuadraturePoint, 8> rule;
  auto at = rule.begin();
  at = detail::put_corner_orbit(0.32816330251638170523, 0.13621784253708734585 / 6, at);
  detail::put_corner_orbit(0.10804724989842862115, 0.11378215746291265415 / 6, at);
  return rule;
}

/// Fourteen points, degree 5 (N. J. Walkington, Quadrature on simplices of arbitrary dimension,
/// 2000): two orbits of (1 - 3a, a, a, a), one of (c, c, d, d), none of them on the boundary.
inline std::array<QuadraturePoint, 14> tet_quadrature_14() {
  std::array<QuadraturePoint, 14> rule;
  auto at = rule.begin();
  at = detail::put_corner_orbit(0.31088591926330060980, 0.11268792571801585080 / 6, at);
  at = detail::put_corner_orbit(0.092735250310891226402, 0.073493043116361949544 / 6, at);
  detail::put_edge_orbit(0.045503704125649649492, 0.042546020777081466438 / 6, at);
  return rule;
}

/// Fifteen points, degree 5 (P. Keast, Comput. Methods Appl. Mech. Eng. 55, 1986, rule 6): the
/// centroid (first), the face centres, (8, 1, 1, 1)/11 and (c, c, d, d) with
/// c, d = (1 -+ sqrt(7/13))/4.
inline std::array<QuadraturePoint, 15> tet_quadrature_15() {
  std::array<QuadraturePoint, 15> rule;
  auto at = rule.begin();
  *at++ = detail::at_barycentric({0.25, 0.25, 0.25, 0.25}, 6544.0 / 36015 / 6);
  at = detail::put_corner_orbit(1.0 / 3, 81.0 / 2240 / 6, at);
  at = detail::put_corner_orbit(1.0 / 11, 161051.0 / 2304960 / 6, at);
  detail::put_edge_orbit((1 - std::sqrt(7.0 / 13)) / 4, 338.0 / 5145 / 6, at);
  return rule;
}

/// Numbers of points that `tet_quadrature` has a rule of.
inline constexpr std::array<int, 4> tet_quadrature_sizes{4, 8, 14, 15};

/// The rule of so many points. Throws core::InternalError if there is none.
inline std::span<const QuadraturePoint> tet_quadrature(int points) {
  static const auto four = tet_quadrature_4();
  static const auto eight = tet_quadrature_8();
  static const auto fourteen = tet_quadrature_14();
  static const auto fifteen = tet_quadrature_15();
  switch (points) {
    case 4:
      return four;
    case 8:
      return eight;
    case 14:
      return fourteen;
    case 15:
      return fifteen;
    default:
      throw core::InternalError("no quadrature rule of " + std::to_string(points) +
                                " points in a tetrahedron");
  }
}

}  // namespace polyslip::mesh
