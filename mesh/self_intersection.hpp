#pragma once
// Where a triangulated surface meets itself.

#include <vector>

#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Triangles that are pierced by, or pierce, a triangle that is not their neighbour there: sorted.
/// An edge that only touches a triangle does not count.
std::vector<int> intersecting_triangles(const SurfaceMesh& surface);

}  // namespace polyslip::mesh
