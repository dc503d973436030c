#pragma once
// The surface of a cell in a topology.

#include "mesh/topology.hpp"

namespace polyslip::mesh {

/// What is wrong with a cell's surface, and the edge, vertex or number of parts.
struct SurfaceFault {
  enum class Kind {
    none,
    edge_not_shared,  ///< an edge is not in exactly two of the cell's faces
    turned_about,     ///< both faces at an edge run along it in the same direction, from the cell
    parts,            ///< it is not connected: the cell is in parts or has another inside
    touching          ///< it meets itself at a vertex
  };
  Kind kind = Kind::none;
  int where = -1;
};

/// None if the surface is closed, connected and touches itself nowhere: a sphere, or one with
/// tunnels. Loops of its faces must be whole.
SurfaceFault surface_fault(const Topology& topology, int cell);

}  // namespace polyslip::mesh
