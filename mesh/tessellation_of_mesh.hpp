#pragma once

#include <string>

#include "mesh/mesh.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// The tessellation that a mesh is one of: its vertices, edges and faces. Edges must be straight
/// within 1e-6 of the box's smallest side; a face keeps its loop, gets the master point that
/// distorts it least, and as plane the mean one of its loop. Seeds are the grains' centroids.
/// check() passes. Throws InputError "<path>: <what>" where there is no such tessellation.
Tessellation tessellation_of(const Mesh& mesh, const std::string& path);

}  // namespace polyslip::mesh
