#pragma once
// Unstructured meshes of the unit cube, made by the program's own meshers.

#include "mesh/mesh.hpp"

namespace polyslip::tests {

/// element_size: c_l of the mesh; needs the mesher pool that this program's main has started.
mesh::Mesh unstructured_cube(double element_size);

}  // namespace polyslip::tests
