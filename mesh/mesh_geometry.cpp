#include "mesh/geometry.hpp"
#include "mesh/pipeline.hpp"

namespace polyslip::mesh {

Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   MesherPool& pool, MeshingReport& report, const MeshingProgress& progress) {
  const auto by = [&](std::vector<std::string> meshers) -> GrainMeshers {
    PoolOptions pool_options;
    pool_options.meshers = std::move(meshers);
    pool_options.element_size = options.element_size;
    pool_options.target = options.mesher_target;
    pool_options.timeout = options.mesher_timeout;
    pool_options.jobs = options.jobs;
    return [&pool, pool_options](std::size_t count, const RequestSource& source,
                                 const ResultSink& sink) {
      pool.mesh(count, source, sink, pool_options);
    };
  };
  const auto& all = options.meshers;
  TurnsOfMeshers turns;
  // In a remeshing the worst element counts for more than O (docs/theory-polycrystal.md, (P.31)).
  if (!geometry.from_mesh && options.slide_boundary && options.mesher_target < 1 && all.size() > 1)
    turns = {by({all.front()}), by({all.begin() + 1, all.end()})};
  return mesh_geometry(geometry, options, scale, by(all), report, progress, turns);
}

}  // namespace polyslip::mesh
