#pragma once
// A mesh made of the meshes of its vertices, edges, faces and grains.

#include <vector>

#include "mesh/boundary_mesh.hpp"
#include "mesh/mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// A grain's surface and the numbers (BoundaryNumbers) of its nodes.
struct GrainSurface {
  SurfaceMesh mesh;          ///< scaled frame, outward normals
  std::vector<int> numbers;  ///< [mesh.nodes]
  std::vector<int> faces;    ///< [mesh.triangles] topology face
};

/// Surface of a grain, nodes in the order of their first use.
GrainSurface grain_surface(const Topology& topology, const BoundaryMesher& boundary,
                           const BoundaryNumbers& numbers, const std::vector<core::Vec3>& positions,
                           int grain, const core::Vec3& scale);

/// Nodes: vertices, edges, faces, insides of grains; then, for order 2, mid nodes of lines, faces,
/// grains. `volumes`: [grains], in the scaled frame, first nodes those of grain_surface; given up
/// grain by grain. InternalError if two edges of a grain's surface join the same nodes,
/// RecoverableError if there are more nodes than 32 bits can number.
Mesh assemble(const Geometry& geometry, const BoundaryMesher& boundary,
              std::vector<VolumeMesh>&& volumes, const core::Vec3& scale, int order, int threads);

}  // namespace polyslip::mesh
