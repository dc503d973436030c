#pragma once
// Whether the grains of a mesh have surfaces that can be meshed.

#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// InputError, naming the grain by `names`, unless each grain's surface is closed, connected and
/// touches itself nowhere (mesh/cell_surface.hpp).
void require_grain_surfaces(const Mesh& mesh, const std::vector<int>& names);

}  // namespace polyslip::mesh
