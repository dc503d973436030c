#pragma once
// Quadratic shape functions of the ten-node tetrahedron and the six-node triangle, in Gmsh's node
// order (mesh/mesh.hpp: tetrahedron_edges, triangle_edges). With the barycentric coordinates
//   l0 = 1 - xi - eta (- zeta), l1 = xi, l2 = eta, l3 = zeta
// corner nodes have N_i = l_i (2 l_i - 1), the mid node between corners i and j has N = 4 l_i l_j.

#include <array>

#include "core/types.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Gradients of l0 ... l3 with respect to (xi, eta, zeta).
inline constexpr std::array<std::array<double, 3>, 4> barycentric_gradients{
    {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// N_i at local coordinates (xi, eta, zeta) of the tetrahedron.
inline std::array<double, 10> tet10_shape(const core::Vec3& xi) {
  const std::array<double, 4> l{1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
  std::array<double, 10> n{};
  for (int i = 0; i < 4; ++i) n[i] = l[i] * (2 * l[i] - 1);
  for (int e = 0; e < 6; ++e)
    n[4 + e] = 4 * l[tetrahedron_edges[e][0]] * l[tetrahedron_edges[e][1]];
  return n;
}

/// dN_i/d(xi, eta, zeta) at local coordinates (xi, eta, zeta).
inline std::array<core::Vec3, 10> tet10_gradients(const core::Vec3& xi) {
  const std::array<double, 4> l{1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
  std::array<core::Vec3, 4> dl;
  for (int i = 0; i < 4; ++i)
    dl[i] = {barycentric_gradients[i][0], barycentric_gradients[i][1], barycentric_gradients[i][2]};
  std::array<core::Vec3, 10> g;
  for (int i = 0; i < 4; ++i) g[i] = (4 * l[i] - 1) * dl[i];
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = tetrahedron_edges[e];
    g[4 + e] = 4 * (l[i] * dl[j] + l[j] * dl[i]);
  }
  return g;
}

/// J = dx/d(xi, eta, zeta) (J(a, b) = dx_a/dxi_b) from the positions of the ten nodes.
inline core::Mat3 tet10_jacobian(const std::array<core::Vec3, 10>& x,
                                 const std::array<core::Vec3, 10>& gradients) {
  core::Mat3 j = core::Mat3::Zero();
  for (int i = 0; i < 10; ++i) j += x[i] * gradients[i].transpose();
  return j;
}

/// N_i at local coordinates (xi, eta) of the triangle.
inline std::array<double, 6> tri6_shape(double xi, double eta) {
  const std::array<double, 3> l{1 - xi - eta, xi, eta};
  return {l[0] * (2 * l[0] - 1), l[1] * (2 * l[1] - 1), l[2] * (2 * l[2] - 1),
          4 * l[0] * l[1],       4 * l[1] * l[2],       4 * l[2] * l[0]};
}

/// dN_i/d(xi, eta) at local coordinates (xi, eta).
inline std::array<std::array<double, 2>, 6> tri6_gradients(double xi, double eta) {
  const double l0 = 1 - xi - eta;
  return {{{1 - 4 * l0, 1 - 4 * l0},
           {4 * xi - 1, 0},
           {0, 4 * eta - 1},
           {4 * (l0 - xi), -4 * xi},
           {4 * eta, 4 * xi},
           {-4 * eta, 4 * (l0 - eta)}}};
}

}  // namespace polyslip::mesh
