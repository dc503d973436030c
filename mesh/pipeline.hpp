#pragma once
// The meshing pipeline with the meshers of grains as a parameter.

#include <functional>

#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Meshes grains as MesherPool::mesh. Surfaces are in the scaled frame.
using GrainMeshers =
    std::function<void(std::size_t count, const RequestSource&, const ResultSink&)>;

/// As mesh_geometry (mesh/geometry.hpp), by `meshers`.
Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   const GrainMeshers& meshers, MeshingReport& report,
                   const MeshingProgress& progress = {});

}  // namespace polyslip::mesh
