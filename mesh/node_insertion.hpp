#pragma once
// New nodes inside a grain, in holes made for them.

#include "mesh/tet_store.hpp"

namespace polyslip::mesh {

/// Puts a node near tetrahedron t: t and some tetrahedra around it give way to those between the
/// node and the facets of the hole, and the node is relocated (by the sum of rho^-power). Only if
/// all of these are above t's radius ratio by more than `gain`; whether they are. Inner nodes in
/// the hole go; t has another number if nothing came of it.
bool insert_node(TetStore& store, int t, double gain, int power);

}  // namespace polyslip::mesh
