#include "mesh/geometry.hpp"
#include "mesh/pipeline.hpp"

namespace polyslip::mesh {

Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   MesherPool& pool, MeshingReport& report, const MeshingProgress& progress) {
  PoolOptions pool_options;
  pool_options.meshers = options.meshers;
  pool_options.element_size = options.element_size;
  pool_options.target = options.mesher_target;
  pool_options.timeout = options.mesher_timeout;
  pool_options.jobs = options.jobs;
  const GrainMeshers meshers = [&](std::size_t count, const RequestSource& source,
                                   const ResultSink& sink) {
    pool.mesh(count, source, sink, pool_options);
  };
  return mesh_geometry(geometry, options, scale, meshers, report, progress);
}

}  // namespace polyslip::mesh
