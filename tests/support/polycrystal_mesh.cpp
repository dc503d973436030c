#include "support/polycrystal_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/geometry.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::tests {

mesh::Mesh polycrystal_mesh(mesh::MesherPool& pool, int grains, double element_size,
                            std::uint64_t seed) {
  mesh::PolycrystalOptions polycrystal;
  polycrystal.grains = grains;
  polycrystal.seed = seed;
  auto tessellation = mesh::voronoi_tessellation(polycrystal);
  mesh::regularise(tessellation, {});
  mesh::MeshingOptions options;
  options.element_size = element_size;
  mesh::MeshingReport report;
  return mesh::mesh_geometry(mesh::geometry_of(tessellation), options, {1, 1, 1}, pool, report);
}

int grains_for(double elements, double element_size) {
  // 675 elements a grain at 0.25 and 130 at 0.5 (docs/benchmarks.md), and a power law between.
  const double each = 130 * std::pow(element_size / 0.5, -2.376);
  return std::max(1, static_cast<int>(std::lround(elements / each)));
}

}  // namespace polyslip::tests
