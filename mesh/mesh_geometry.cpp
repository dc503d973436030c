#include "mesh/geometry.hpp"
#include "mesh/pipeline.hpp"

namespace polyslip::mesh {
namespace {

/// Whether our optimiser belongs to a mesher (docs/theory-polycrystal.md, section 5).
bool has_own_optimiser(const std::string& mesher) {
  return !mesher.ends_with("-plain") && !mesher.starts_with("paper-");
}

PoolOptions pool_options(const MeshingOptions& options, std::vector<std::string> meshers) {
  PoolOptions result;
  result.meshers = std::move(meshers);
  result.element_size = options.element_size;
  result.target = options.mesher_target;
  result.timeout = options.mesher_timeout;
  result.jobs = options.jobs;
  return result;
}

}  // namespace

Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   MesherPool& pool, MeshingReport& report, const MeshingProgress& progress) {
  const auto by = [&](std::vector<std::string> meshers, bool optimise = true) -> GrainMeshers {
    PoolOptions chosen = pool_options(options, std::move(meshers));
    chosen.optimise = optimise;
    return [&pool, chosen](std::size_t count, const RequestSource& source, const ResultSink& sink) {
      pool.mesh(count, source, sink, chosen);
    };
  };
  const auto& all = options.meshers;
  TurnsOfMeshers turns;
  // In a remeshing the worst element counts for more than O (docs/theory-polycrystal.md, (P.31)).
  if (!geometry.from_mesh && options.slide_boundary && options.mesher_target < 1 &&
      all.size() > 1) {
    turns = {by({all.front()}, false), by({all.begin() + 1, all.end()}),
             has_own_optimiser(all.front())};
    for (const auto& mesher : all) turns.each.push_back(by({mesher}));
  }
  const FaceMeshers face_meshers = [&](const std::vector<FaceRequest>& requests,
                                       const std::string& mesher) {
    return pool.mesh_faces(requests, mesher, pool_options(options, {mesher}));
  };
  return mesh_geometry(geometry, options, scale, by(all), report, progress, turns, face_meshers);
}

}  // namespace polyslip::mesh
