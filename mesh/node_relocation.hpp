#pragma once
// Moving, adding and taking away nodes inside a grain.

#include "mesh/tet_store.hpp"

namespace polyslip::mesh {

/// Gradient of ln rho (P.23) of the positive tetrahedron (x, p, q, r) by x.
core::Vec3 log_radius_ratio_gradient(const core::Vec3& x, const core::Vec3& p, const core::Vec3& q,
                                     const core::Vec3& r);

/// rho^-power; power is a multiple of three.
inline double barrier(double rho, int power) {
  const double cubed = 1 / (rho * rho * rho);
  double value = cubed;
  for (int i = 3; i < power; i += 3) value *= cubed;
  return value;
}

/// Moves a free node down the gradient of (P.29), the sum over its star of rho^-power, by a step
/// that is halved until the sum falls and the star's least radius ratio does not. Whether it moved.
bool relocate(TetStore& store, int node, int power = 3);

/// Puts a node into the middle of inner edge a-b and relocates it, if the least radius ratio of the
/// edge's ring grows by more than `gain` so; whether it did.
bool split_edge(TetStore& store, int a, int b, double gain);

/// Moves a free node onto that neighbour for which the star's least radius ratio is largest
/// afterwards, if it grows by more than `gain`; whether it did.
bool collapse_node(TetStore& store, int node, double gain);

}  // namespace polyslip::mesh
