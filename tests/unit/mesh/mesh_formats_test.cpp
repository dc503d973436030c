// Files for ParaView and Abaqus, read back by small parsers of their own.

#include "mesh/mesh_formats.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "core/rotation.hpp"
#include "mesh/inp_writer.hpp"
#include "mesh/vtu_writer.hpp"
#include "support/box_mesh.hpp"
#include "unit/mesh/reader_support.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Mesh sample() {
  Mesh mesh = tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2);
  tests::distort(mesh, 0.1);
  return mesh;
}

const std::vector<core::Quaternion> turned{core::from_rodrigues({0.1, 0.2, 0.3}),
                                           core::from_rodrigues({0, 0, -0.4})};
const std::vector<int> numbers{3, 8};

/// The arrays of a .vtu by name, as bytes; by the layout that VTK's documentation gives.
std::map<std::string, std::string> arrays_of(const std::string& text) {
  std::map<std::string, std::string> arrays;
  const std::size_t data = text.find("<AppendedData encoding=\"raw\">");
  EXPECT_NE(data, std::string::npos);
  const std::size_t begin = text.find('_', data) + 1;
  const auto attribute = [&](std::size_t at, const std::string& name) {
    const std::size_t from = text.find(name + "=\"", at) + name.size() + 2;
    return text.substr(from, text.find('"', from) - from);
  };
  for (std::size_t at = 0; (at = text.find("<DataArray ", at)) < data; ++at) {
    const std::size_t offset = begin + std::stoul(attribute(at, "offset"));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, text.data() + offset, 8);
    arrays[attribute(at, "Name")] = text.substr(offset + 8, bytes);
  }
  // The last array ends where the closing tag begins.
  EXPECT_NE(text.find("\n</AppendedData>\n</VTKFile>\n"), std::string::npos);
  return arrays;
}

template <class T>
std::vector<T> values(const std::string& bytes) {
  std::vector<T> list(bytes.size() / sizeof(T));
  std::memcpy(list.data(), bytes.data(), list.size() * sizeof(T));
  return list;
}

TEST(VtuWriter, HoldsTheMeshInVtksOrder) {
  const Mesh mesh = sample();
  const TemporaryFile file("mesh.vtu", "");
  write_mesh(mesh, file.path(), MeshFormat::vtu, {.orientations = turned, .ids = numbers});
  auto arrays = arrays_of(core::read_text(file.path()));
  const auto x = values<double>(arrays["Points"]);
  ASSERT_EQ(x.size(), 3 * mesh.nodes.size());
  const auto point = [&](int n) { return Vec3(x[3 * n], x[3 * n + 1], x[3 * n + 2]); };
  const auto nodes = values<std::int32_t>(arrays["connectivity"]);
  ASSERT_EQ(nodes.size(), 10 * mesh.tetrahedra.size());
  // VTK_QUADRATIC_TETRA: mid nodes of (0,1), (1,2), (2,0), (0,3), (1,3), (2,3).
  constexpr int middles[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    for (int m = 0; m < 6; ++m) {
      const int* t = nodes.data() + 10 * e;
      EXPECT_LT((point(t[4 + m]) - (point(t[middles[m][0]]) + point(t[middles[m][1]])) / 2).norm(),
                1e-14);
    }
  EXPECT_EQ(values<std::int64_t>(arrays["offsets"]).back(),
            static_cast<std::int64_t>(nodes.size()));
  const auto types = values<std::uint8_t>(arrays["types"]);
  EXPECT_EQ(std::set<int>(types.begin(), types.end()), std::set<int>{24});
  const auto grains = values<std::int32_t>(arrays["grain"]);
  const auto rho = values<double>(arrays["radius_ratio"]);
  const auto q = values<double>(arrays["orientation"]);
  ASSERT_EQ(rho.size(), mesh.tetrahedra.size());
  ASSERT_EQ(q.size(), 4 * mesh.tetrahedra.size());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    EXPECT_EQ(grains[e], numbers[mesh.tetrahedron_cell[e]]);
    EXPECT_GT(rho[e], 0.3);
    EXPECT_EQ(q[4 * e], turned[mesh.tetrahedron_cell[e]].w());
    EXPECT_EQ(q[4 * e + 3], turned[mesh.tetrahedron_cell[e]].z());
  }
}

TEST(VtuWriter, PolyhedraCloseAndHaveTheCellsVolumes) {
  Tessellation t = voronoi_tessellation({.grains = 20, .seed = 3, .domain = {1, 1, 1}});
  regularise(t, {.max_edge_length = 0.3});
  const TemporaryFile file("cells.vtu", "");
  write_vtu(t, file.path());
  auto arrays = arrays_of(core::read_text(file.path()));
  const auto x = values<double>(arrays["Points"]);
  EXPECT_GT(x.size(), 3 * t.vertices.size());  // barycentres of faces that are not flat
  const auto faces = values<std::int32_t>(arrays["faces"]);
  const auto volumes = values<double>(arrays["volume"]);
  ASSERT_EQ(volumes.size(), 20U);
  std::size_t at = 0;
  for (int c = 0; c < 20; ++c) {
    double volume = 0;
    std::map<std::pair<int, int>, int> sides;
    for (int f = faces[at++]; f > 0; --f) {
      const int n = faces[at++];
      std::vector<Vec3> loop;
      for (int i = 0; i < n; ++i) {
        const int a = faces[at + i], b = faces[at + (i + 1) % n];
        ++sides[{a, b}];
        loop.emplace_back(x[3 * a], x[3 * a + 1], x[3 * a + 2]);
      }
      at += n;
      for (int i = 1; i + 1 < n; ++i) volume += loop[0].dot(loop[i].cross(loop[i + 1])) / 6;
    }
    EXPECT_NEAR(volume, volumes[c], 1e-8);
    EXPECT_NEAR(volume, cell_volume(t, c), 1e-8);
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(sides.count({side.second, side.first}), 1U);
    }
  }
  EXPECT_EQ(at, faces.size());
}

/// An Abaqus file by its keyword lines.
struct Block {
  std::string keyword;
  std::vector<std::vector<double>> rows;
};
std::vector<Block> blocks_of(const std::string& text) {
  std::vector<Block> blocks;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    EXPECT_LE(line.size(), 256U);
    if (line[0] == '*') {
      blocks.push_back({line, {}});
      continue;
    }
    std::vector<double> row;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) {
      while (!word.empty() && word[0] == ' ') word.erase(0, 1);
      EXPECT_LE(word.size(), 20U);
      row.push_back(std::strtod(word[0] == 'S' ? word.c_str() + 1 : word.c_str(), nullptr));
    }
    EXPECT_LE(row.size(), 16U);
    blocks.back().rows.push_back(row);
  }
  return blocks;
}

TEST(InpWriter, HoldsElementsAndSetsInAbaqusOrder) {
  const Mesh mesh = sample();
  const TemporaryFile file("mesh.inp", "");
  write_mesh(mesh, file.path(), MeshFormat::inp, {.orientations = turned, .ids = numbers});
  std::map<int, Vec3> nodes;
  std::map<int, std::vector<int>> elements;
  std::map<std::string, std::size_t> grains;
  double surfaces = 0;
  int orientations = 0;
  for (const Block& block : blocks_of(core::read_text(file.path()))) {
    if (block.keyword.starts_with("*NODE"))
      for (const auto& r : block.rows) nodes[static_cast<int>(r[0])] = {r[1], r[2], r[3]};
    if (block.keyword.starts_with("*ELEMENT, TYPE=C3D10, ELSET=")) {
      grains[block.keyword.substr(28)] = block.rows.size();
      for (const auto& r : block.rows)
        elements[static_cast<int>(r[0])] = std::vector<int>(r.begin() + 1, r.end());
    }
    if (block.keyword == "*NSET, NSET=X1") {
      std::size_t count = 0;
      for (const auto& r : block.rows)
        for (const double n : r) {
          EXPECT_EQ(nodes.at(static_cast<int>(n))[0], 2);
          ++count;
        }
      EXPECT_EQ(count, 25U);
    }
    if (block.keyword.starts_with("*SURFACE, TYPE=ELEMENT, NAME=SURFACE_"))
      for (const auto& r : block.rows) {
        // S1 ... S4 of Abaqus' manual, corners from 1.
        constexpr int corners[4][3] = {{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
        const auto& t = elements.at(static_cast<int>(r[0]));
        const auto& s = corners[static_cast<int>(r[1]) - 1];
        const Vec3 a = nodes.at(t[s[0] - 1]), b = nodes.at(t[s[1] - 1]), c = nodes.at(t[s[2] - 1]);
        surfaces += (b - a).cross(c - a).norm() / 2;
      }
    if (block.keyword.starts_with("*ORIENTATION, NAME=ORIENTATION_GRAIN3,")) {
      ++orientations;
      const Vec3 along = turned[0] * Vec3::UnitX(), across = turned[0] * Vec3::UnitY();
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(block.rows[0][i], along[i], 1e-12);
        EXPECT_NEAR(block.rows[0][3 + i], across[i], 1e-12);
      }
    }
  }
  EXPECT_EQ(nodes.size(), mesh.nodes.size());
  ASSERT_EQ(elements.size(), mesh.tetrahedra.size());
  EXPECT_EQ(grains, (std::map<std::string, std::size_t>{{"GRAIN3", 48}, {"GRAIN8", 48}}));
  EXPECT_NEAR(surfaces, 10, 1e-12);  // of the box 2 x 1 x 1
  EXPECT_EQ(orientations, 1);
  // C3D10: mid nodes of (1,2), (2,3), (3,1), (1,4), (2,4), (3,4).
  constexpr int middles[6][2] = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}};
  for (const auto& [id, t] : elements)
    for (int m = 0; m < 6; ++m)
      EXPECT_LT((nodes[t[4 + m]] - (nodes[t[middles[m][0] - 1]] + nodes[t[middles[m][1] - 1]]) / 2)
                    .norm(),
                1e-12);
}

TEST(MeshFormats, NamesAndExtensions) {
  EXPECT_EQ(mesh_format("msh4-binary"), MeshFormat::msh4_binary);
  EXPECT_EQ(mesh_format("stl"), std::nullopt);
  EXPECT_EQ(file_extension(MeshFormat::msh4), ".msh");
  EXPECT_EQ(file_extension(MeshFormat::inp), ".inp");
  for (const std::string& name : mesh_format_names()) EXPECT_TRUE(mesh_format(name)) << name;
}

TEST(MeshFormats, AnUnwritablePathIsTheUsersToMend) {
  const Mesh mesh = sample();
  for (const std::string& name : mesh_format_names())
    EXPECT_THROW(write_mesh(mesh, "/no/such/folder/mesh", *mesh_format(name)), core::InputError);
}

}  // namespace
}  // namespace polyslip::mesh
