#pragma once
// Moving, adding and taking away nodes inside a grain.

#include "mesh/tet_store.hpp"

namespace polyslip::mesh {

/// Gradient of ln rho (P.23) of the positive tetrahedron (x, p, q, r) by x.
core::Vec3 log_radius_ratio_gradient(const core::Vec3& x, const core::Vec3& p, const core::Vec3& q,
                                     const core::Vec3& r);

/// Moves a free node down the gradient of (P.29), the sum over its star of rho^-3, by a step that
/// is halved until the sum falls and the star's least radius ratio does not. Whether it moved.
bool relocate(TetStore& store, int node);

/// Puts a node into the middle of inner edge a-b and relocates it, if the least radius ratio of the
/// edge's ring grows by more than `gain` so; whether it did.
bool split_edge(TetStore& store, int a, int b, double gain);

/// Moves a free node onto that neighbour for which the star's least radius ratio is largest
/// afterwards, if it grows by more than `gain`; whether it did.
bool collapse_node(TetStore& store, int node, double gain);

}  // namespace polyslip::mesh
