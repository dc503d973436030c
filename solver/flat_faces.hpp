#pragma once
// Whether the body has flowed past the planes of its flat faces: contact is not computed.

#include <vector>

#include "solver/boundary.hpp"
#include "solver/partition.hpp"

namespace polyslip::solver {

/// How far a node lies beyond the plane of a flat face that it is not on.
struct FlowPast {
  int face = -1;        ///< 0 ... 5: x0 ... z1; -1: no node does
  double distance = 0;  ///< over the body's length across that face
};

/// The farthest. Flat are faces whose normal position is prescribed, which the deck's dies and
/// symmetry planes are; a homogeneous boundary has none. x: [local_nodes][3]; strain: of the load.
/// The same on every rank. Collective.
FlowPast farthest_past_flat_faces(const LocalMesh& local, const Boundary& boundary,
                                  const std::vector<double>& x, double strain);

}  // namespace polyslip::solver
