#pragma once
// Some of a mesh's panels as one surface.

#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/surface_panels.hpp"

namespace polyslip::mesh {

/// These panels; mid nodes that a mesh of order 1 lacks are in the middle.
FaceShape shape_of(const Mesh& mesh, const std::vector<Panel>& panels,
                   const std::vector<int>& which);

/// Whether a remeshing will find a map of this disc into a plane, with something to spare for what
/// it will be bent.
bool lies_flat(const FaceShape& shape);

}  // namespace polyslip::mesh
