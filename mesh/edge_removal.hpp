#pragma once
// Changes of one grain's tetrahedra that leave the nodes where they are.

#include "mesh/tet_store.hpp"

namespace polyslip::mesh {

/// Replaces the n tetrahedra around inner edge a-b, 3 <= n <= max_ring, by the 2 (n - 2) over and
/// under that triangulation of the ring's polygon whose least radius ratio is largest (P.28): flips
/// 3-2, 4-4 and the longer ones. Only if that least one grows by more than `gain`; whether it did.
bool remove_edge(TetStore& store, int a, int b, double gain);

/// Flip 2-3: replaces t and its neighbour beyond the facet opposite to corner i by the three
/// tetrahedra around the edge between the corners that the facet parts. Only if the least radius
/// ratio grows by more than `gain`; whether it did.
bool flip_facet(TetStore& store, int t, int i, double gain);

}  // namespace polyslip::mesh
