// Gmsh itself reads what we write, and we read what it writes.

#include <fmt/format.h>
#include <gmsh.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "mesh/geometry.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/msh_writer.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::mesh {
namespace {

class GmshFiles : public testing::Test {
 protected:
  void SetUp() override {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    path_ = testing::TempDir() + fmt::format("polyslip_gmsh_{}.msh", ::getpid());
  }
  void TearDown() override {
    gmsh::finalize();
    std::filesystem::remove(path_);
  }

  std::string path_;
};

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const double v : grain_volumes(mesh)) sum += v;
  return sum;
}

TEST_F(GmshFiles, PeriodicMeshesGoThereAndBack) {
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  PolycrystalOptions polycrystal{.grains = 4, .seed = 3};
  polycrystal.periodic = {true, true, false};
  auto t = voronoi_tessellation(polycrystal);
  regularise(t, {});
  MeshingOptions meshing;
  meshing.element_size = 0.7;
  MeshingReport report;
  const Mesh mesh = mesh_geometry(geometry_of(t), meshing, core::Vec3::Ones(), *pool, report);
  // Of format 2.2 Gmsh 4.8 keeps the nodes but not the pairs.
  for (const bool binary : {false, true}) {
    SCOPED_TRACE(fmt::format("binary {}", binary));
    write_msh(mesh, path_, {.newest = true, .binary = binary});
    gmsh::clear();
    gmsh::open(path_);
    for (const auto& pair : mesh.topology.periodic.faces) {
      int master = 0;
      std::vector<std::size_t> nodes, of_master;
      std::vector<double> motion;
      gmsh::model::mesh::getPeriodicNodes(2, pair.slave + 1, master, nodes, of_master, motion);
      EXPECT_EQ(master, pair.master + 1);
      ASSERT_EQ(motion.size(), 16u);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(motion[4 * k + 3], pair.shift[k] * mesh.size[k]);
      ASSERT_GE(nodes.size(), 6u);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        EXPECT_LT((mesh.nodes[nodes[i] - 1] -
                   translated(mesh.nodes[of_master[i] - 1], pair.shift, mesh.size))
                      .norm(),
                  1e-12);
    }
    for (const double version : {2.2, 4.1})
      for (const int type : {0, 1}) {
        gmsh::option::setNumber("Mesh.MshFileVersion", version);
        gmsh::option::setNumber("Mesh.Binary", type);
        gmsh::option::setNumber("Mesh.SaveAll", 1);
        gmsh::write(path_);
        const MeshFile read = read_msh(path_);
        EXPECT_EQ(read.mesh.element_count(), mesh.element_count());
        EXPECT_EQ(read.mesh.domain.periodic, mesh.domain.periodic);
        EXPECT_EQ(read.mesh.periodic_nodes.size(), mesh.periodic_nodes.size());
        EXPECT_EQ(read.mesh.topology.periodic.faces.size(), mesh.topology.periodic.faces.size());
      }
  }
}

TEST_F(GmshFiles, GoThereAndBack) {
  Mesh mesh = tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2);
  tests::distort(mesh, 0.1);
  for (const bool newest : {false, true})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(fmt::format("newest {} binary {}", newest, binary));
      write_msh(mesh, path_, {newest, binary});
      gmsh::clear();
      gmsh::open(path_);
      std::vector<std::size_t> tags, elements, nodes;
      std::vector<double> x, unused;
      gmsh::model::mesh::getNodes(tags, x, unused);
      ASSERT_EQ(tags.size(), mesh.nodes.size());
      for (std::size_t i = 0; i < tags.size(); ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(x[3 * i + k], mesh.nodes[tags[i] - 1][k]);
      gmsh::model::mesh::getElementsByType(11, elements, nodes);
      ASSERT_EQ(elements.size(), mesh.tetrahedra.size());
      gmsh::vectorpair groups;
      gmsh::model::getPhysicalGroups(groups, 3);
      ASSERT_EQ(groups.size(), 2U);
      for (int grain = 1; grain <= 2; ++grain) {
        std::string name;
        gmsh::model::getPhysicalName(3, grain, name);
        EXPECT_EQ(name, fmt::format("grain{}", grain));
        std::vector<int> entities;
        gmsh::model::getEntitiesForPhysicalGroup(3, grain, entities);
        EXPECT_EQ(entities, std::vector<int>{grain});
      }
      gmsh::model::getPhysicalGroups(groups, 2);
      EXPECT_EQ(groups.size(), 6U);
      std::string name;
      gmsh::model::getPhysicalName(2, 6, name);
      EXPECT_EQ(name, "z1");
      for (const double version : {2.2, 4.1})
        for (const int type : {0, 1}) {
          gmsh::option::setNumber("Mesh.MshFileVersion", version);
          gmsh::option::setNumber("Mesh.Binary", type);
          gmsh::write(path_);
          const MeshFile read = read_msh(path_);
          EXPECT_EQ(read.mesh.element_count(), mesh.element_count());
          EXPECT_EQ(read.mesh.node_count(), mesh.node_count());
          EXPECT_NEAR(volume(read.mesh), volume(mesh), 1e-12);
          EXPECT_EQ(read.mesh.topology.faces.size(), mesh.topology.faces.size());
        }
    }
}

}  // namespace
}  // namespace polyslip::mesh
