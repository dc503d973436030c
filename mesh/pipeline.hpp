#pragma once
// The meshing pipeline with the meshers of grains as a parameter.

#include <functional>
#include <vector>

#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Meshes grains as MesherPool::mesh. Surfaces are in the scaled frame.
using GrainMeshers =
    std::function<void(std::size_t count, const RequestSource&, const ResultSink&)>;

/// Meshers for grains whose meshes are judged when nodes have slid only; none: judged before.
struct TurnsOfMeshers {
  GrainMeshers first;   ///< for all grains
  GrainMeshers others;  ///< for grains without a mesh by the first
  /// Whether meshes by the first still lack our optimiser: what nodes slide by has passed it, and
  /// what has not is the other candidate once they have.
  bool unoptimised = false;
  /// All meshers, one by one, for the grains with the worst elements.
  std::vector<GrainMeshers> each{};
};

/// As mesh_geometry (mesh/geometry.hpp), by `meshers`; with `turns`, these make the grains' first
/// meshes, and grains that are not good enough once nodes have slid (mesh/candidate.hpp) are left
/// to `meshers`. Faces by our own mesher alone if there are no `face_meshers`.
Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   const GrainMeshers& meshers, MeshingReport& report,
                   const MeshingProgress& progress = {}, const TurnsOfMeshers& turns = {},
                   const FaceMeshers& face_meshers = {});

}  // namespace polyslip::mesh
