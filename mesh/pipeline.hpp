#pragma once
// The meshing pipeline with the meshers of grains as a parameter.

#include <functional>
#include <vector>

#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Meshes grains; results in the order of the requests. Surfaces are in the scaled frame.
using GrainMeshers = std::function<std::vector<GrainResult>(const std::vector<GrainRequest>&)>;

/// As mesh_geometry (mesh/geometry.hpp), by `meshers`.
Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   const GrainMeshers& meshers, MeshingReport& report,
                   const std::function<void(double fraction)>& progress = {});

}  // namespace polyslip::mesh
