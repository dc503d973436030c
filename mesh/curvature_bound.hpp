#pragma once
// How far the map of a ten-node tetrahedron can be from that of the straight one.

#include <array>
#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// An e such that det J >= (1 - e)^3 det J0 > 0 all over the element if e < 1 (J0: the straight
/// element's); infinite if the straight element is not positive, NaN if a node is no number.
/// For with the mid nodes' bulges b_k, J = J0 (I + sum_k J0^-1 b_k (grad N_k)^T), whose sum has no
/// larger norm than e = sum_k |J0^-1 b_k| max |grad N_k|, and the gradient of N_k = 4 l_i l_j,
/// 4 (l_i grad l_j + l_j grad l_i), is at most 4 |grad l_0| = 4 sqrt 3 with l_i + l_j <= 1.
inline double curvature_bound(const Mesh& mesh, int element) {
  const auto& t = mesh.tetrahedra[element];
  const auto& x = mesh.nodes;
  const core::Vec3 u = x[t[1]] - x[t[0]], v = x[t[2]] - x[t[0]], w = x[t[3]] - x[t[0]];
  const core::Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double det = u.dot(vw);
  if (det <= 0) return std::numeric_limits<double>::infinity();
  if (mesh.order == 1) return 0 * det;
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    const auto& [i, j] = tetrahedron_edges[k];
    const core::Vec3 bulge = x[t[4 + k]] - (x[t[i]] + x[t[j]]) / 2;
    sum += core::Vec3(vw.dot(bulge), wu.dot(bulge), uv.dot(bulge)).norm();
  }
  return 4 * std::sqrt(3.0) * sum / det;
}

}  // namespace polyslip::mesh
