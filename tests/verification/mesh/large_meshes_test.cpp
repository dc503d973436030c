// Large meshes hold the quality that is promised of every one (docs/benchmarks.md).

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/geometry.hpp"
#include "mesh/measures.hpp"

namespace polyslip::mesh {
namespace {

Mesh mesh_of(const PolycrystalOptions& polycrystal, double element_size, MeshingReport& report) {
  auto t = voronoi_tessellation(polycrystal);
  regularise(t, {});
  MeshingOptions options;
  options.element_size = element_size;
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  Mesh mesh = mesh_geometry(geometry_of(t), options, core::Vec3::Ones(), *pool, report);
  check(mesh);
  return mesh;
}

/// Radius ratios of the elements: how many lie below a bound.
long below(const Mesh& mesh, double bound) {
  long count = 0;
  for (int e = 0; e < mesh.element_count(); ++e)
    count += !(measure_element(mesh, e).radius_ratio >= bound);
  return count;
}

TEST(LargeMeshes, SlowSheetOfTenThousandGrainsOneGrainThick) {
  MeshingReport report;
  const Mesh mesh = mesh_of({.grains = 10000, .domain = core::Vec3(100, 100, 1)}, 0.5, report);
  EXPECT_EQ(mesh.topology.cell_count(), 10000);
  EXPECT_EQ(below(mesh, 0.05), 0);
}

TEST(LargeMeshes, SlowThousandGrainsAtAQuarter) {
  MeshingReport report;
  const double c_l = 0.25;
  const Mesh mesh = mesh_of({.grains = 1000}, c_l, report);
  const auto grains = measure_grain_meshes(mesh, c_l);
  double worst = 0, O = 0;
  for (const auto& grain : grains) {
    worst += grain.min_radius_ratio / 1000;
    O += grain.O / 1000;
  }
  EXPECT_EQ(below(mesh, 0.05), 0);
  EXPECT_LE(static_cast<double>(below(mesh, 0.1)), 3e-5 * mesh.element_count());
  EXPECT_GT(worst, 0.40);
  EXPECT_GT(O, 0.90);
}

}  // namespace
}  // namespace polyslip::mesh
