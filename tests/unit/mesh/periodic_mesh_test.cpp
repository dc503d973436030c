#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numeric>

#include "core/error.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesh/pipeline.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Mesh periodic_mesh(int grains, const std::array<bool, 3>& directions, int order) {
  PolycrystalOptions polycrystal;
  polycrystal.grains = grains;
  polycrystal.seed = 3;
  polycrystal.periodic = directions;
  auto t = voronoi_tessellation(polycrystal);
  regularise(t, {});
  MeshingOptions options;
  options.element_size = 0.7;
  options.order = order;
  options.jobs = 1;
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  MeshingReport report;
  return mesh_geometry(geometry_of(t), options, Vec3::Ones(), *pool, report);
}

class PeriodicMesh : public testing::TestWithParam<std::array<bool, 3>> {};

TEST_P(PeriodicMesh, OppositeFacesMatchNodeForNode) {
  const auto& directions = GetParam();
  for (const int order : {1, 2}) {
    const Mesh mesh = periodic_mesh(order == 2 ? 6 : 1, directions, order);
    check(mesh);
    const auto volumes = grain_volumes(mesh);
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0) / mesh.size.prod(), 1, 1e-12);
    ASSERT_FALSE(mesh.periodic_nodes.empty());
    for (const auto& pair : mesh.periodic_nodes)
      EXPECT_EQ(mesh.nodes[pair.slave], translated(mesh.nodes[pair.master], pair.shift, mesh.size));
    // Every node of a periodic face is one of a pair.
    std::vector<char> paired(mesh.nodes.size(), 0), periodic(mesh.topology.faces.size(), 0);
    for (const auto& pair : mesh.periodic_nodes) paired[pair.slave] = paired[pair.master] = 1;
    for (const auto& pair : mesh.topology.periodic.faces)
      periodic[pair.slave] = periodic[pair.master] = 1;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int n : mesh.triangles[t])
        if (n >= 0 && periodic[mesh.triangle_face[t]]) {
          EXPECT_TRUE(paired[n]);
        }
  }
}

INSTANTIATE_TEST_SUITE_P(Directions, PeriodicMesh,
                         testing::Values(std::array{true, false, false},
                                         std::array{false, true, true},
                                         std::array{true, true, true}));

TEST(PeriodicMesh, CheckSeesANodeThatLeavesItsTranslate) {
  Mesh mesh = periodic_mesh(4, {true, true, true}, 2);
  const auto good = mesh;
  mesh.nodes[mesh.periodic_nodes.back().slave] += Vec3(1e-9, 0, 0);
  EXPECT_THROW(check(mesh), core::InternalError);
  mesh = good;
  mesh.periodic_nodes.pop_back();
  EXPECT_THROW(check(mesh), core::InternalError);
  mesh = good;
  mesh.periodic_nodes.front().shift[0] += 1;
  EXPECT_THROW(check(mesh), core::InternalError);
  EXPECT_NO_THROW(check(good));
}

TEST(PeriodicMesh, PairsAreWrittenAsTheFileNumbersNodes) {
  const Mesh mesh = periodic_mesh(1, {true, false, false}, 1);
  const std::string path = testing::TempDir() + "/pairs-" + std::to_string(getpid()) + ".csv";
  write_periodic_nodes(mesh, path);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "slave,master,shift_x,shift_y,shift_z");
  std::size_t rows = 0;
  for (int slave, master, x, y, z; file >> slave; ++rows) {
    char c;
    file >> c >> master >> c >> x >> c >> y >> c >> z;
    EXPECT_EQ(mesh.nodes[slave - 1], translated(mesh.nodes[master - 1], {x, y, z}, mesh.size));
  }
  EXPECT_EQ(rows, mesh.periodic_nodes.size());
}

}  // namespace
}  // namespace polyslip::mesh
