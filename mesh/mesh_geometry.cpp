#include "mesh/geometry.hpp"
#include "mesh/pipeline.hpp"

namespace polyslip::mesh {

Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   MesherPool& pool, MeshingReport& report,
                   const std::function<void(double)>& progress) {
  PoolOptions pool_options;
  pool_options.meshers = options.meshers;
  pool_options.element_size = options.element_size;
  pool_options.timeout = options.mesher_timeout;
  pool_options.jobs = options.jobs;
  const GrainMeshers meshers = [&](const std::vector<GrainRequest>& requests) {
    return pool.mesh(requests, pool_options);
  };
  return mesh_geometry(geometry, options, scale, meshers, report, progress);
}

}  // namespace polyslip::mesh
