// Periodic meshes in .msh files.

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/geometry.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/msh_writer.hpp"
#include "mesh/tessellation_of_mesh.hpp"
#include "reader_support.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Directions3 = std::array<bool, 3>;

Mesh periodic_mesh(int grains, const Directions3& directions, int order, double element_size) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = 3;
  options.domain = {1.5, 1, 1};
  options.periodic = directions;
  auto t = voronoi_tessellation(options);
  RegularisationOptions regularisation;
  regularisation.max_edge_length = 0.3;
  regularise(t, regularisation);
  MeshingOptions meshing;
  meshing.element_size = element_size;
  meshing.order = order;
  meshing.jobs = 1;
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  MeshingReport report;
  return mesh_geometry(geometry_of(t), meshing, Vec3::Ones(), *pool, report);
}

Mesh there_and_back(const Mesh& mesh, const MshOptions& options) {
  const TemporaryFile file("periodic.msh", "");
  write_msh(mesh, file.path(), options);
  return read_msh(file.path()).mesh;
}

/// Nodes and elements bit for bit; entities, which files do not number, one to one.
void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.domain.periodic, b.domain.periodic);
  ASSERT_EQ(a.periodic_nodes.size(), b.periodic_nodes.size());
  for (std::size_t i = 0; i < a.periodic_nodes.size(); ++i) {
    EXPECT_EQ(a.periodic_nodes[i].slave, b.periodic_nodes[i].slave);
    EXPECT_EQ(a.periodic_nodes[i].master, b.periodic_nodes[i].master);
    EXPECT_EQ(a.periodic_nodes[i].shift, b.periodic_nodes[i].shift);
  }
  EXPECT_EQ(a.topology.faces.size(), b.topology.faces.size());
  EXPECT_EQ(a.topology.edges.size(), b.topology.edges.size());
  EXPECT_EQ(a.topology.vertex_count, b.topology.vertex_count);
  EXPECT_EQ(a.topology.periodic.faces.size(), b.topology.periodic.faces.size());
  EXPECT_EQ(a.topology.periodic.edges.size(), b.topology.periodic.edges.size());
  EXPECT_EQ(a.topology.periodic.vertices.size(), b.topology.periodic.vertices.size());
  auto p = a.vertex_nodes, q = b.vertex_nodes;
  std::sort(p.begin(), p.end());
  std::sort(q.begin(), q.end());
  EXPECT_EQ(p, q);
}

const std::vector<Directions3> one_two_three{
    {true, false, false}, {false, true, true}, {true, true, true}};

TEST(PeriodicMsh, ComesBackBitForBit) {
  for (const auto& directions : one_two_three) {
    const Mesh mesh = periodic_mesh(12, directions, 2, 0.7);
    for (const bool newest : {false, true})
      for (const bool binary : {false, true}) {
        SCOPED_TRACE(testing::Message() << "newest " << newest << ", binary " << binary);
        expect_same(mesh, there_and_back(mesh, {newest, binary}));
      }
  }
}

TEST(PeriodicMsh, OfOneAndTwoGrainsAndOrderOneComesBack) {
  for (const int grains : {1, 2}) {
    const Mesh mesh = periodic_mesh(grains, {true, true, true}, 1, 0.4);
    expect_same(mesh, there_and_back(mesh, {}));
  }
}

TEST(PeriodicMsh, GivesTheTessellation) {
  const Mesh mesh = periodic_mesh(12, {true, true, false}, 2, 0.7);
  const Tessellation t = tessellation_of(there_and_back(mesh, {}), "file");
  EXPECT_EQ(t.topology.periodic.faces.size(), mesh.topology.periodic.faces.size());
  EXPECT_EQ(t.domain.periodic, mesh.domain.periodic);
}

TEST(PeriodicMsh, WithoutMotionsIsReadFromItsNodes) {
  const Mesh mesh = periodic_mesh(3, {true, false, true}, 1, 0.5);
  const TemporaryFile file("periodic.msh", "");
  write_msh(mesh, file.path(), {});
  std::string text = core::read_text(file.path());
  for (auto at = text.find("Affine"); at != std::string::npos; at = text.find("Affine"))
    text.erase(at, text.find('\n', at) + 1 - at);
  const TemporaryFile bare("periodic-bare.msh", text);
  const Mesh read = read_msh(bare.path()).mesh;
  ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    EXPECT_LT((read.nodes[i] - mesh.nodes[i]).norm(), 1e-12);
  EXPECT_EQ(read.periodic_nodes.size(), mesh.periodic_nodes.size());
}

TEST(PeriodicMsh, SaysWhatIsWrong) {
  const Mesh mesh = periodic_mesh(1, {true, true, true}, 1, 0.6);
  const TemporaryFile file("periodic.msh", "");
  write_msh(mesh, file.path(), {});
  const std::string text = core::read_text(file.path());
  const auto fault = [](const std::string& changed) {
    return fault_of("periodic.msh", changed, [](const std::string& path) { read_msh(path); });
  };
  EXPECT_EQ(fault(text), "");
  EXPECT_NE(fault(replaced(text, "Affine 1 0 ", "Affine 0 1 ")).find("no translation"),
            std::string::npos);
  const auto section = text.find("$Periodic");
  const auto rows = text.find("Affine", section);
  const auto count = text.find('\n', rows) + 1, first = text.find('\n', count) + 1;
  const auto end = text.find('\n', first);
  auto missing = text;
  missing.replace(first, end - first, "1 999999");
  EXPECT_NE(fault(missing).find("$Periodic has node 999999"), std::string::npos) << fault(missing);
  auto wrong = text;
  const auto second = text.find('\n', end + 1);
  const std::string a = text.substr(first, end - first), b = text.substr(end + 1, second - end - 1);
  wrong.replace(first, second - first,
                a.substr(0, a.find(' ')) + b.substr(b.find(' ')) + "\n" + b.substr(0, b.find(' ')) +
                    a.substr(a.find(' ')));
  EXPECT_NE(fault(wrong).find("off its periodic place"), std::string::npos) << fault(wrong);
}

}  // namespace
}  // namespace polyslip::mesh
