// Both versions of Gmsh's format, ASCII and binary: what is written comes back.

#include <fmt/format.h>

#include <algorithm>

#include "core/random.hpp"
#include "core/rotation.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/msh_writer.hpp"
#include "support/box_mesh.hpp"
#include "unit/mesh/reader_support.hpp"

namespace polyslip::mesh {
namespace {

constexpr std::array<MshOptions, 4> formats{
    {{false, false}, {false, true}, {true, false}, {true, true}}};

std::string name(const MshOptions& f) {
  return fmt::format("{}{}", f.newest ? "4.1" : "2.2", f.binary ? " binary" : "");
}

Mesh sample(int order) {
  Mesh mesh = tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2);
  tests::distort(mesh, 0.1);
  if (order == 2) return mesh;
  // Only corners stay.
  std::vector<int> number(mesh.nodes.size(), -1);
  std::vector<core::Vec3> nodes;
  const auto keep = [&](auto& list, int corners) {
    for (auto& t : list)
      for (std::size_t i = 0; i < t.size(); ++i) {
        if (static_cast<int>(i) >= corners) {
          t[i] = -1;
          continue;
        }
        if (number[t[i]] < 0) {
          number[t[i]] = static_cast<int>(nodes.size());
          nodes.push_back(mesh.nodes[t[i]]);
        }
        t[i] = number[t[i]];
      }
  };
  keep(mesh.tetrahedra, 4);
  keep(mesh.triangles, 3);
  keep(mesh.lines, 2);
  for (int& n : mesh.vertex_nodes) n = number[n];
  mesh.nodes = nodes;
  mesh.order = 1;
  return mesh;
}

std::string bytes_of(const Mesh& mesh, const MshOptions& format,
                     std::span<const core::Quaternion> orientations = {}) {
  const TemporaryFile file("formats.msh", "");
  write_msh(mesh, file.path(), format, {.orientations = orientations, .ids = {}});
  return core::read_text(file.path());
}

MeshFile read_bytes(const std::string& bytes) {
  const TemporaryFile file("formats.msh", bytes);
  return read_msh(file.path());
}

TEST(MshFormats, EachComesBackBitForBit) {
  core::Random random(4, core::Stream::tests);
  const std::vector<core::Quaternion> orientations{random.rotation(), random.rotation()};
  for (const int order : {1, 2}) {
    const Mesh mesh = sample(order);
    ASSERT_NO_THROW(check(mesh));
    for (const MshOptions& format : formats) {
      SCOPED_TRACE(name(format));
      const std::string bytes = bytes_of(mesh, format, orientations);
      const MeshFile read = read_bytes(bytes);
      EXPECT_EQ(read.mesh.order, order);
      EXPECT_EQ(read.mesh.nodes, mesh.nodes);
      EXPECT_EQ(read.mesh.tetrahedra, mesh.tetrahedra);
      EXPECT_EQ(read.mesh.tetrahedron_cell, mesh.tetrahedron_cell);
      ASSERT_TRUE(read.orientations);
      ASSERT_EQ(read.orientations->size(), 2U);
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_LT(core::rotation_angle(read.orientations->at(i).conjugate() * orientations[i]),
                  1e-15);
      // Numbers of faces are found anew, so the file is the same from the second time on.
      const std::string again = bytes_of(read.mesh, format, *read.orientations);
      EXPECT_EQ(bytes_of(read_bytes(again).mesh, format, *read.orientations), again);
    }
  }
}

/// Turns the bytes of the integers and numbers of a binary file of format 2.2 round.
std::string of_other_byte_order(std::string bytes, const Mesh& mesh) {
  const auto turn = [&](std::size_t& at, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<long>(at),
                 bytes.begin() + static_cast<long>(at + size));
    at += size;
  };
  std::size_t at = bytes.find('\n', bytes.find("2.2 1 8")) + 1;
  turn(at, 4);
  at = bytes.find('\n', bytes.find("$Nodes\n") + 7) + 1;
  for (int n = 0; n < mesh.node_count(); ++n) {
    turn(at, 4);
    for (int i = 0; i < 3; ++i) turn(at, 8);
  }
  at = bytes.find('\n', bytes.find("$Elements\n", at) + 10) + 1;
  while (bytes.compare(at, 13, "\n$EndElements") != 0) turn(at, 4);
  return bytes;
}

TEST(MshFormats, ReadsTheOtherByteOrder) {
  const Mesh mesh = sample(2);
  const MeshFile read = read_bytes(of_other_byte_order(bytes_of(mesh, {false, true}), mesh));
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.tetrahedra, mesh.tetrahedra);
}

TEST(MshFormats, NoTruncatedFileIsAccepted) {
  const Mesh mesh = sample(1);
  for (const MshOptions& format : formats) {
    SCOPED_TRACE(name(format));
    const std::string bytes = bytes_of(mesh, format);
    for (std::size_t part = 0; part < 10; ++part) {
      const std::string cut = bytes.substr(0, bytes.size() * part / 10);
      const std::string message =
          fault_of("cut.msh", cut, [](const std::string& path) { read_msh(path); });
      EXPECT_NE(message, "") << part;
    }
  }
}

std::string fault(const std::string& bytes) {
  return fault_of("fault.msh", bytes, [](const std::string& path) { read_msh(path); });
}

TEST(MshFormats, SaysWhatIsWrongInTheNewerFormat) {
  const Mesh mesh = sample(1);
  const std::string text = bytes_of(mesh, {true, false});
  ASSERT_EQ(fault(text), "");
  const std::string nodes = fmt::format("$Nodes\n1 {} ", mesh.node_count());
  EXPECT_NE(fault(replaced(text, nodes, fmt::format("$Nodes\n1 {} ", mesh.node_count() - 1)))
                .find("nodes in blocks"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, nodes, "$Nodes\n1 999999999 "))
                .find("the number of nodes is 999999999, which the rest of the file cannot hold"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "$Entities", "$PartitionedEntities")).find("is partitioned"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "\n3 1 4 48\n", "\n3 1 5 48\n")).find("elements of Gmsh's type 5"),
            std::string::npos)
      << text.substr(text.find("$Elements"), 40);
  const std::string binary = bytes_of(mesh, {true, true});
  EXPECT_NE(fault(replaced(binary, "$EndNodes", "$EndKnots")).find("at byte "), std::string::npos);
}

// Neper's numbers of groups, and orientations of elements in place of grains.
TEST(MshFormats, KnowsNepersSections) {
  const std::string text = bytes_of(sample(1), {});
  EXPECT_EQ(fault(text + "$Groups\nelset\n2\n1 1\n2 2\n$EndGroups\n"), "");
  EXPECT_NE(fault(text + "$Groups\nelement\n2\n1 1\n2 2\n$EndGroups\n").find("groups of 'element'"),
            std::string::npos);
  EXPECT_NE(fault(text + "$ElementOrientations\n1 rodrigues:passive\n1 0 0 0\n"
                         "$EndElementOrientations\n")
                .find("orientations are those of single elements"),
            std::string::npos);
}

}  // namespace
}  // namespace polyslip::mesh
