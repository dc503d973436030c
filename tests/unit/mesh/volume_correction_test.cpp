#include "mesh/volume_correction.hpp"

#include <gtest/gtest.h>

#include "star_meshes.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using namespace test;

TEST(VolumeCorrection, KnowsTheVolumesInsideQuadraticFaces) {
  MeshingReport report;
  Mesh mesh = star_mesh(cubes(2), options_of(0.5), report);
  for (auto& x : mesh.nodes) x = deformed(x, 0.3, 0.08);
  const auto inside = grain_volumes(geometry_of(mesh)), exact = grain_volumes(mesh);
  ASSERT_EQ(inside.size(), 8u);
  for (int g = 0; g < 8; ++g) EXPECT_NEAR(inside[g], exact[g], 1e-13);
}

TEST(VolumeCorrection, GivesGrainsTheVolumeAskedForByInnerMidNodesOnly) {
  MeshingReport report;
  const Mesh before = star_mesh(cubes(2), options_of(0.5), report);
  Mesh mesh = before;
  std::vector<double> wanted(8, 1.0);
  wanted[3] += 2e-3, wanted[6] -= 1e-3, wanted[0] -= 1e-3;
  std::vector<char> fixed;
  for (const auto& f : mesh.topology.faces) fixed.push_back(f.domain_face >= 0);
  const double largest = correct_volumes(mesh, wanted, fixed);
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(largest, 2e-3);
  const auto volumes = grain_volumes(mesh);
  for (int g = 0; g < 8; ++g) EXPECT_NEAR(volumes[g], wanted[g], 1e-7);
  ASSERT_NO_THROW(check(mesh));
  expect_box(mesh);
  std::vector<char> stays(mesh.nodes.size(), true);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!fixed[mesh.triangle_face[i]])
      for (int k = 3; k < 6; ++k) stays[mesh.triangles[i][k]] = false;
  for (const auto& l : mesh.lines) stays[l[2]] = true;
  for (int n = 0; n < mesh.node_count(); ++n) {
    if (stays[n]) {
      EXPECT_EQ(mesh.nodes[n], before.nodes[n]);
    }
  }
}

}  // namespace
}  // namespace polyslip::mesh
