// Periodic tessellations in .tess files.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/file.hpp"
#include "mesh/tess_reader.hpp"
#include "mesh/tess_writer.hpp"
#include "reader_support.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Directions3 = std::array<bool, 3>;

Tessellation periodic(int grains, const Directions3& directions, double l_max) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = 3;
  options.domain = {1.5, 1, 1};
  options.periodic = directions;
  Tessellation t = voronoi_tessellation(options);
  RegularisationOptions regularisation;
  regularisation.max_edge_length = l_max;
  regularise(t, regularisation);
  return t;
}

void expect_same_pairs(const std::vector<PeriodicPair>& a, const std::vector<PeriodicPair>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].slave, b[i].slave);
    EXPECT_EQ(a[i].master, b[i].master);
    EXPECT_EQ(a[i].shift, b[i].shift);
  }
}

void expect_same(const Tessellation& a, const Tessellation& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.seeds, b.seeds);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.domain.periodic, b.domain.periodic);
  EXPECT_EQ(a.face_masters, b.face_masters);
  EXPECT_EQ(a.topology.cell_faces, b.topology.cell_faces);
  ASSERT_EQ(a.topology.edges.size(), b.topology.edges.size());
  for (std::size_t e = 0; e < a.topology.edges.size(); ++e)
    EXPECT_EQ(a.topology.edges[e].vertices, b.topology.edges[e].vertices);
  ASSERT_EQ(a.topology.faces.size(), b.topology.faces.size());
  for (std::size_t f = 0; f < a.topology.faces.size(); ++f) {
    EXPECT_EQ(a.topology.faces[f].edges, b.topology.faces[f].edges);
    EXPECT_EQ(a.topology.faces[f].forward, b.topology.faces[f].forward);
    EXPECT_EQ(a.topology.faces[f].cells, b.topology.faces[f].cells);
    EXPECT_EQ(a.topology.faces[f].domain_face, b.topology.faces[f].domain_face);
    EXPECT_EQ(a.face_planes[f].normal, b.face_planes[f].normal);
    EXPECT_EQ(a.face_planes[f].offset, b.face_planes[f].offset);
  }
  expect_same_pairs(a.topology.periodic.vertices, b.topology.periodic.vertices);
  expect_same_pairs(a.topology.periodic.edges, b.topology.periodic.edges);
  expect_same_pairs(a.topology.periodic.faces, b.topology.periodic.faces);
}

std::string written(const Tessellation& t) {
  const TemporaryFile file("periodic.tess", "");
  write_tess(t, file.path());
  return core::read_text(file.path());
}

Tessellation read_text(const std::string& text, LengthUnit unit = LengthUnit::grain) {
  const TemporaryFile file("periodic-read.tess", text);
  return read_tess(file.path(), unit).tessellation;
}

std::string fault(const std::string& text) {
  try {
    read_text(text);
  } catch (const core::InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find(".tess:") + 6);
  }
  return {};
}

const std::vector<Directions3> one_two_three{
    {true, false, false}, {false, true, true}, {true, true, true}};

TEST(PeriodicTess, ComesBackBitForBit) {
  for (const auto& directions : one_two_three)
    for (const int grains : {1, 3, 40})
      for (const double l_max : {0.0, 0.3}) {
        SCOPED_TRACE(testing::Message() << grains << " grains, l_max " << l_max);
        const auto t = periodic(grains, directions, l_max);
        expect_same(t, read_text(written(t)));
      }
}

TEST(PeriodicTess, IsRegularisedAgainToNoEffect) {
  const auto t = periodic(40, {true, true, true}, 0.3);
  auto read = read_text(written(t));
  RegularisationOptions options;
  options.max_edge_length = 0.3;
  EXPECT_EQ(regularise(read, options).deleted, 0);
  expect_same(t, read);
}

/// The file as another program could write it: moved, scaled, the section named as in the diagram
/// of Neper's reference, secondaries that run against their primaries, loops that begin elsewhere.
TEST(PeriodicTess, OfOtherProgramsIsBroughtToOurOrder) {
  auto t = periodic(30, {true, true, true}, 0.13);
  const auto expected = t;
  auto& topology = t.topology;
  std::vector<char> turned(topology.edges.size(), false);
  for (std::size_t i = 0; i < topology.periodic.edges.size(); i += 2) {
    const int e = topology.periodic.edges[i].slave;
    turned[e] = true;
    std::swap(topology.edges[e].vertices[0], topology.edges[e].vertices[1]);
  }
  for (auto& face : topology.faces)
    for (std::size_t i = 0; i < face.edges.size(); ++i)
      if (turned[face.edges[i]]) face.forward[i] = !face.forward[i];
  for (std::size_t i = 0; i < topology.periodic.faces.size(); i += 3) {
    auto& face = topology.faces[topology.periodic.faces[i].slave];
    std::rotate(face.edges.begin(), face.edges.begin() + 1, face.edges.end());
    std::rotate(face.forward.begin(), face.forward.begin() + 1, face.forward.end());
    t.face_masters[topology.periodic.faces[i].slave] = -1;
  }
  std::string text = written(t);
  const auto rows = text.find("**periodicity");
  std::size_t row = text.find("*edge", rows);
  for (const auto& pair : topology.periodic.edges) {
    row = text.find("\n   " + std::to_string(pair.slave + 1) + " ", row);
    const auto end = text.find('\n', row + 1);
    if (turned[pair.slave]) text.replace(end - 1, 1, "-1");
    row = end - 1;
  }
  text.replace(rows, 13, "**periodic");
  expect_same(expected, read_text(text));
}

TEST(PeriodicTess, IsScaledToGrainsOfUnitVolume) {
  auto t = periodic(20, {true, false, false}, 0.13);
  const auto expected = t;
  const double scale = 2;
  for (auto& x : t.vertices) x *= scale;
  for (auto& x : t.seeds) x *= scale;
  for (auto& p : t.face_planes) p.offset *= scale;
  t.domain = box_domain(scale * t.domain.size);
  t.domain.periodic = {true, false, false};
  t.size = t.domain.size;
  const auto read = read_text(written(t));
  read.check();
  for (std::size_t v = 0; v < t.vertices.size(); ++v)
    EXPECT_LT((read.vertices[v] - expected.vertices[v]).norm(), 1e-12);
  EXPECT_LT((read.size - expected.size).norm(), 1e-12);
  EXPECT_EQ(read_text(written(t), LengthUnit::file).vertices, t.vertices);
}

TEST(PeriodicTess, SaysWhatIsWrong) {
  const auto t = periodic(12, {true, true, true}, 0.13);
  const std::string text = written(t);
  const auto replaced = [&](const std::string& old, const std::string& by) {
    auto copy = text;
    const auto at = copy.find(old, copy.find("**periodicity"));
    EXPECT_NE(at, std::string::npos) << old;
    return copy.replace(at, old.size(), by);
  };
  const auto has = [](const std::string& whole, const std::string& part) {
    return whole.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(fault(replaced("1 1 1", "1 2 1")), "periodicity is 2, neither 0 nor 1"));
  EXPECT_TRUE(has(fault(replaced("1 1 1", "0 1 1")), "along a direction that is not periodic"));
  const auto sizes = text.find("\n  ", text.find("*general", text.find("**periodicity")));
  ASSERT_NE(sizes, std::string::npos);
  const auto& pair = t.topology.periodic.vertices.front();
  const std::string row = "\n   " + std::to_string(pair.slave + 1) + " ";
  EXPECT_TRUE(has(fault(replaced(row + std::to_string(pair.master + 1) + " ",
                                 row + std::to_string(pair.slave + 1) + " ")),
                  "is its own primary"));
  EXPECT_TRUE(has(fault(replaced(row, "\n   99999 ")), "a secondary is 99999, not one of 1 ... "));
  EXPECT_TRUE(has(fault(text.substr(0, text.find(" **periodicity")) + "***end\n"),
                  "has no cell beyond it"));
}

}  // namespace
}  // namespace polyslip::mesh
