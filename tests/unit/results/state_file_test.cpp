#include "results/state_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "results/hdf5.hpp"

namespace polyslip {
namespace {

using results::read_state;
using results::write_state;
using tests::fabricated_snapshot;

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same_topology(const mesh::Topology& a, const mesh::Topology& b) {
  EXPECT_EQ(a.vertex_count, b.vertex_count);
  EXPECT_EQ(a.cell_faces, b.cell_faces);
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t i = 0; i < a.edges.size(); ++i)
    EXPECT_EQ(a.edges[i].vertices, b.edges[i].vertices);
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    EXPECT_EQ(a.faces[i].edges, b.faces[i].edges);
    EXPECT_EQ(a.faces[i].forward, b.faces[i].forward);
    EXPECT_EQ(a.faces[i].cells, b.faces[i].cells);
    EXPECT_EQ(a.faces[i].domain_face, b.faces[i].domain_face);
  }
}

void expect_same_mesh(const mesh::Mesh& a, const mesh::Mesh& b) {
  EXPECT_EQ(a.order, b.order);
  EXPECT_TRUE(same_bits(a.nodes, b.nodes));
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.tetrahedron_cell, b.tetrahedron_cell);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangle_face, b.triangle_face);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.line_edge, b.line_edge);
  EXPECT_EQ(a.vertex_nodes, b.vertex_nodes);
  EXPECT_EQ(a.size, b.size);
  expect_same_topology(a.topology, b.topology);
}

void expect_same(const mesh::Snapshot& a, const mesh::Snapshot& b) {
  expect_same_mesh(a.mesh, b.mesh);
  EXPECT_EQ(a.mesh_number, b.mesh_number);
  EXPECT_EQ(a.quadrature_points, b.quadrature_points);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.strain, b.strain);
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.history, b.history);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].name, b.fields[i].name);
    EXPECT_EQ(a.fields[i].location, b.fields[i].location);
    EXPECT_EQ(a.fields[i].components, b.fields[i].components);
    EXPECT_EQ(a.fields[i].unit, b.fields[i].unit);
    EXPECT_EQ(a.fields[i].transport, b.fields[i].transport);
    EXPECT_EQ(a.fields[i].description, b.fields[i].description);
    EXPECT_TRUE(same_bits(a.fields[i].values, b.fields[i].values)) << a.fields[i].name;
  }
}

std::string error_of(const std::string& path) {
  try {
    read_state(path);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

/// The snapshot without its fields' values.
mesh::Snapshot outline_of(mesh::Snapshot s) {
  for (auto& field : s.fields) field.values.clear();
  return s;
}

TEST(StateFile, AnOutlineReadPieceByPieceGivesTheSameBytes) {
  const tests::TemporaryFolder folder;
  const mesh::Snapshot whole = fabricated_snapshot(12, 0.3);
  ASSERT_GT(whole.mesh.element_count(), 20000);
  const mesh::FieldReader values = mesh::reader_of(whole);
  std::size_t most = 0;
  const mesh::FieldReader read = [&](const mesh::Field& field, std::size_t first,
                                     std::size_t last) {
    most = std::max(most, last - first);
    return values(*whole.find(field.name, field.location), first, last);
  };
  write_state(folder / "whole.h5", whole);
  write_state(folder / "pieces.h5", outline_of(whole), read);
  EXPECT_TRUE(tests::slurp(folder / "pieces.h5") == tests::slurp(folder / "whole.h5"));
  EXPECT_GT(most, 0u);
  EXPECT_LT(most, 20000u);
  expect_same(read_state(folder / "pieces.h5"), whole);
}

TEST(StateFile, AReaderThatFailsLeavesTheEarlierFile) {
  const tests::TemporaryFolder folder;
  const mesh::Snapshot whole = fabricated_snapshot(1, 0.3);
  write_state(folder / "a.h5", whole);
  const std::string before = tests::slurp(folder / "a.h5");
  int left = 5;
  const mesh::FieldReader values = mesh::reader_of(whole);
  const auto read = [&](const mesh::Field& field, std::size_t first, std::size_t last) {
    if (--left == 0) throw core::RecoverableError("no more");
    return values(*whole.find(field.name, field.location), first, last);
  };
  EXPECT_THROW(write_state(folder / "a.h5", outline_of(whole), read), core::RecoverableError);
  EXPECT_EQ(tests::slurp(folder / "a.h5"), before);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5.part"));
}

TEST(StateFile, ReadsBackBitForBit) {
  const tests::TemporaryFolder folder;
  auto written = fabricated_snapshot(2, 0.3, 4);
  ASSERT_GT(written.fields.size(), 6u);
  auto& values = written.find("slip")->values;
  values[0] = -0.0;
  values[1] = std::numeric_limits<double>::denorm_min();
  values[2] = std::numeric_limits<double>::quiet_NaN();
  values[3] = -std::numeric_limits<double>::infinity();
  write_state(folder / "a.h5", written);
  expect_same(written, read_state(folder / "a.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5.part"));
}

TEST(StateFile, SameSnapshotSameBytes) {
  const tests::TemporaryFolder folder;
  write_state(folder / "a.h5", fabricated_snapshot(1, 0.3));
  write_state(folder / "b.h5", read_state(folder / "a.h5"));
  EXPECT_EQ(tests::slurp(folder / "a.h5"), tests::slurp(folder / "b.h5"));
  write_state(folder / "b.h5", fabricated_snapshot(1, 0.31));
  EXPECT_NE(tests::slurp(folder / "a.h5"), tests::slurp(folder / "b.h5"));
}

TEST(StateFile, EveryDamageIsOneClearLine) {
  const tests::TemporaryFolder folder;
  write_state(folder / "a.h5", fabricated_snapshot(1, 0.3));
  const std::string good = tests::slurp(folder / "a.h5");
  ASSERT_GT(good.size(), 2000u);
  const auto expect_damaged = [&](const std::string& bytes, const std::string& how) {
    tests::spit(folder / "x.h5", bytes);
    const std::string error = error_of(folder / "x.h5");
    EXPECT_NE(error.find("x.h5: is damaged ("), std::string::npos) << how << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{100}, std::size_t{512}, good.size() / 2, good.size() - 1})
    expect_damaged(good.substr(0, length), "cut to " + std::to_string(length) + " ");
  expect_damaged(good + "x", "longer ");
  for (std::size_t place = 0; place < good.size(); place += place < 600 ? 7 : good.size() / 40) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 4);
    tests::spit(folder / "x.h5", bad);
    EXPECT_NE(error_of(folder / "x.h5"), "") << "bit flipped at " << place;
  }
  tests::spit(folder / "x.h5", good);
  EXPECT_EQ(error_of(folder / "x.h5"), "");
  EXPECT_NE(error_of(folder / "none.h5").find("none.h5: no such file"), std::string::npos);
}

TEST(StateFile, UnwritablePlaceIsAnInputError) {
  const tests::TemporaryFolder folder;
  EXPECT_THROW(write_state(folder / "none/a.h5", fabricated_snapshot(1, 0)), core::InputError);
  tests::spit(folder / "file", "");
  EXPECT_THROW(write_state(folder / "file/a.h5", fabricated_snapshot(1, 0)), core::InputError);
}

TEST(StateFile, WrongSizesNeverReachTheDisk) {
  const tests::TemporaryFolder folder;
  auto s = fabricated_snapshot(1, 0.1);
  s.find("slip")->values.pop_back();
  EXPECT_THROW(write_state(folder / "a.h5", s), core::InternalError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(StateFile, HoldsWhatUsersLookFor) {
  const tests::TemporaryFolder folder;
  const auto s = fabricated_snapshot(1, 0.2);
  write_state(folder / "a.h5", s);
  const auto file = results::hdf5::File::open(folder / "a.h5");
  EXPECT_EQ(file.read_text_attribute("/", "file_type"), "polyslip-state");
  EXPECT_EQ(file.read_int_attribute("/", "version"), 1);
  EXPECT_EQ(file.read_text_attribute("elements/cauchy_stress", "unit"), "MPa");
  std::vector<std::int32_t> grain(s.mesh.tetrahedra.size());
  ASSERT_EQ(file.shape("mesh/grain", results::hdf5::Number::int32).at(0), grain.size());
  file.read("mesh/grain", results::hdf5::Number::int32, grain.data());
  EXPECT_EQ(grain.front(), 1);
  EXPECT_EQ(grain.back(), 2);
  std::vector<std::int32_t> vtk(10 * s.mesh.tetrahedra.size());
  file.read("mesh/tetrahedra_vtk", results::hdf5::Number::int32, vtk.data());
  // VTK: mid node 4 + i lies between these corners.
  constexpr int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const auto rest = tests::two_grains(1);  // straight edges
  for (std::size_t e = 0; e < rest.tetrahedra.size(); ++e)
    for (int i = 0; i < 6; ++i) {
      const auto at = [&](int n) { return rest.nodes[vtk[10 * e + n]]; };
      EXPECT_LT((0.5 * (at(ends[i][0]) + at(ends[i][1])) - at(4 + i)).norm(), 1e-15);
    }
}

}  // namespace
}  // namespace polyslip
