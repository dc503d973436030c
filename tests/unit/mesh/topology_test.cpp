#include "mesh/topology.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

Topology small() {
  PolycrystalOptions options;
  options.grains = 8;
  return voronoi_tessellation(options).topology;
}

template <class Break>
void expect_refused(Break&& spoil, const std::string& word) {
  Topology t = small();
  t.check();
  spoil(t);
  try {
    t.check();
    FAIL() << "accepted; expected: " << word;
  } catch (const core::InternalError& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

TEST(Topology, AVoronoiTessellationPassesAndEmptyFails) {
  small().check();
  EXPECT_THROW(Topology{}.check(), core::InternalError);
}

TEST(Topology, FaceVerticesAreTheStartsOfItsEdges) {
  const Topology t = small();
  for (int f = 0; f < static_cast<int>(t.faces.size()); ++f) {
    const auto v = t.face_vertices(f);
    const auto& face = t.faces[f];
    ASSERT_EQ(v.size(), face.edges.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto& ends = t.edges[face.edges[i]].vertices;
      EXPECT_EQ(v[i], ends[face.forward[i] ? 0 : 1]);
      EXPECT_EQ(v[(i + 1) % v.size()], ends[face.forward[i] ? 1 : 0]);
    }
  }
}

TEST(Topology, RefusesEachBrokenInvariant) {
  expect_refused([](Topology& t) { t.edges[3].vertices[1] = t.edges[3].vertices[0]; },
                 "identical ends");
  expect_refused([](Topology& t) { t.edges[0].vertices[0] = t.vertex_count; }, "has vertices");
  expect_refused([](Topology& t) { t.faces[2].forward[0] = !t.faces[2].forward[0]; }, "open");
  expect_refused([](Topology& t) { t.faces[2].edges[0] = -1; }, "has edge");
  expect_refused([](Topology& t) { t.faces[2].forward.pop_back(); }, "directions");
  expect_refused([](Topology& t) { t.faces[1].cells[0] = 8; }, "lies between");
  expect_refused([](Topology& t) { t.faces[1].domain_face = 7; }, "domain face");
  expect_refused(
      [](Topology& t) {
        for (auto& f : t.faces)
          if (f.cells[1] >= 0) f.domain_face = 0;
      },
      "outer cell");
  expect_refused([](Topology& t) { t.cell_faces[0].pop_back(); }, "listed by");
  expect_refused([](Topology& t) { t.cell_faces[0].push_back(t.cell_faces[0][0]); }, "twice");
  expect_refused([](Topology& t) { std::swap(t.faces[0].edges, t.faces[1].edges); }, "face 0");
  expect_refused([](Topology& t) { ++t.vertex_count; }, "unused");
  expect_refused(
      [](Topology& t) {
        for (auto& f : t.faces)
          if (f.cells[1] >= 0) {
            std::swap(f.cells[0], f.cells[1]);
            return;
          }
      },
      "orientation");
}

}  // namespace
}  // namespace polyslip::mesh
