#include "mesh/size_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

TEST(EdgeNodes, AreEvenWhereNothingIsSmall) {
  const auto s = edge_nodes(1.0, 0.25, 0.25, 0.25, 2);
  ASSERT_EQ(s.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s[i], 0.25 * i, 1e-15);
  EXPECT_EQ(edge_nodes(0.3, 0.25, 0.25, 0.25, 2).size(), 2u);
  EXPECT_EQ(edge_nodes(0.36, 0.25, 0.25, 0.25, 2).size(), 3u) << "sqrt 2 is the limit";
  EXPECT_EQ(edge_nodes(1e-3, 0.25, 0.25, 0.25, 2).size(), 2u);
}

TEST(EdgeNodes, AreAsManyAsAskedFor) {
  for (const int count : {1, 2, 3, 7}) {
    const auto s = edge_nodes(0.3, 0.25, 0.1, 0.25, 2, count);
    EXPECT_GE(s.size(), count + 1u);
    EXPECT_LE(largest_progression(s), 2);
  }
  EXPECT_EQ(edge_nodes(0.3, 0.25, 0.25, 0.25, 2, 5).size(), 6u);
}

TEST(NodesPutIn, AreWhereTheyAreAskedForWhereTheProgressionLetsThem) {
  const EdgeGrading grading{0.5, 0.5, 0.5, 2};
  const std::vector<double> one{0, 1};
  EXPECT_EQ(with_node_at(one, 0.4, grading), (std::vector<double>{0, 0.4, 1}));
  // Near a node: that one moves.
  EXPECT_EQ(with_node_at({0, 0.5, 1}, 0.45, grading), (std::vector<double>{0, 0.45, 1}));
  core::Random random(5, core::Stream::tests);
  for (int i = 0; i < 500; ++i) {
    const double length = random.uniform(0.2, 3), p = random.uniform(1.3, 3);
    const EdgeGrading g{random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), 0.5, p};
    const auto arcs = edge_nodes(length, g.from, g.to, 0.5, p);
    const double arc = random.uniform(0.2, 0.8) * length;
    const auto s = with_node_at(arcs, arc, g);
    EXPECT_LE(largest_progression(s), p * (1 + 1e-8));
    EXPECT_EQ(s.front(), 0);
    EXPECT_EQ(s.back(), length);
  }
  EXPECT_TRUE(std::isinf(largest_progression({0, 0.5, 0.4, 1})));
  EXPECT_TRUE(std::isinf(largest_progression({0, std::nan(""), 1})));
}

TEST(EdgeNodes, StartFromTheSizeOfTheVertexAndGrowByTheFactor) {
  // 0.1 (1 + 2 + 4) = 0.7, then 0.8 each.
  const auto s = edge_nodes(0.7 + 4 * 0.8, 0.1, 0.8, 0.8, 2);
  ASSERT_GE(s.size(), 7u);
  EXPECT_NEAR(s[1], 0.1, 0.02);
  EXPECT_NEAR((s[2] - s[1]) / s[1], 2, 0.2);
}

TEST(EdgeNodes, KeepTheProgressionFactorWhateverTheSizes) {
  core::Random random(3, core::Stream::tests);
  for (int i = 0; i < 2000; ++i) {
    const double size = 0.25, p = random.uniform(1.05, 3), length = random.uniform(0.01, 4);
    const double from = size * random.uniform(0.05, 1), to = size * random.uniform(0.05, 1);
    const auto s = edge_nodes(length, from, to, size, p);
    EXPECT_EQ(s.front(), 0);
    EXPECT_EQ(s.back(), length);
    for (std::size_t k = 1; k < s.size(); ++k) {
      const double l = s[k] - s[k - 1];
      EXPECT_GT(l, 0);
      EXPECT_LE(l, size * 1.4143);
      if (k < 2) continue;
      const double before = s[k - 1] - s[k - 2];
      EXPECT_LE(std::max(l, before) / std::min(l, before), p * (1 + 1e-8)) << i;
    }
  }
  for (double tiny : {1e-5, 1e-8, 1e-10}) {  // lengths that rounding of the nodes shows in
    EXPECT_GE(edge_nodes(1.0, tiny, 0.25, 0.25, 1.5).size(), 3u);
    EXPECT_GE(edge_nodes(1.0, tiny, 0.25, 0.25, 100).size(), 3u);
  }
  EXPECT_THROW(edge_nodes(0.0, 0.1, 0.1, 0.25, 2), core::RecoverableError);
  EXPECT_THROW(edge_nodes(1.0, 0.0, 0.1, 0.25, 2), core::RecoverableError);
  EXPECT_THROW(edge_nodes(std::nan(""), 0.1, 0.1, 0.25, 2), core::RecoverableError);
  EXPECT_EQ(edge_nodes(1.0, 0.25, 0.1, 0.25, 1.0).size(), 11u) << "factor 1: the smallest size";
}

TEST(VertexSizes, AreThoseOfTheShortestEdgeTimesTheFactor) {
  Topology t;
  t.vertex_count = 4;
  t.edges = {{{0, 1}}, {{1, 2}}, {{2, 3}}};
  const auto sizes = vertex_sizes(t, {0.1, 0.24, 0.9}, {0.25, 0.25, 0.25}, 2);
  EXPECT_DOUBLE_EQ(sizes[0], 0.2);
  EXPECT_DOUBLE_EQ(sizes[1], 0.2);
  EXPECT_DOUBLE_EQ(sizes[2], 0.25);
  EXPECT_DOUBLE_EQ(sizes[3], 0.25);
}

TEST(ElementSizes, AreTheLeastOfTheGrainsAround) {
  const auto tessellation = voronoi_tessellation(PolycrystalOptions{.grains = 60, .seed = 2});
  const auto& t = tessellation.topology;
  MeshingOptions options;
  options.element_size = 0.2;
  options.outer_element_size = 0.5;
  const auto sizes = element_sizes(t, options);
  std::vector<char> outer(t.cell_count(), false);
  for (const auto& f : t.faces)
    if (f.domain_face >= 0) outer[f.cells[0]] = true;
  int inner = 0;
  for (int c = 0; c < t.cell_count(); ++c) {
    EXPECT_EQ(sizes.grains[c], outer[c] ? 0.5 : 0.2);
    inner += !outer[c];
  }
  EXPECT_GT(inner, 0);
  for (std::size_t f = 0; f < t.faces.size(); ++f) {
    double least = 1;
    for (int c : t.faces[f].cells)
      if (c >= 0) least = std::min(least, sizes.grains[c]);
    EXPECT_EQ(sizes.faces[f], least);
    for (int e : t.faces[f].edges) EXPECT_LE(sizes.edges[e], least);
  }
  options.grain_element_sizes.assign(60, 0.3);
  EXPECT_EQ(element_sizes(t, options).grains, options.grain_element_sizes);
  options.grain_element_sizes.pop_back();
  EXPECT_THROW(element_sizes(t, options), core::InputError);
}

TEST(CurvedEdge, MeasuresAParabola) {
  // y = x^2 on 0 ... 1: length (2 sqrt 5 + asinh 2) / 4.
  const EdgeShape shape{{{0, 0, 0}, {0.5, 0.25, 0}, {1, 1, 0}}};
  const CurvedEdge edge(shape, Vec3::Ones());
  EXPECT_NEAR(edge.length(), (2 * std::sqrt(5.0) + std::asinh(2.0)) / 4, 1e-8);
  const Vec3 x = edge.at(0.4 * edge.length());
  EXPECT_NEAR(x[1], x[0] * x[0], 1e-15);
  const double t = x[0];
  const double to_x = (2 * t * std::sqrt(1 + 4 * t * t) + std::asinh(2 * t)) / 4;
  EXPECT_NEAR(to_x, 0.4 * edge.length(), 1e-8);
  EXPECT_EQ(edge.at(0), shape.points[0]);
  EXPECT_EQ(edge.at(edge.length()), shape.points[2]);
}

TEST(CurvedEdge, TakesLengthsInTheScaledFrameAndGivesRealPoints) {
  const EdgeShape shape{{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 0.5, 0}, {1, 1, 0}}};
  const CurvedEdge edge(shape, Vec3(2, 3, 1));
  EXPECT_NEAR(edge.length(), 5, 1e-14);
  EXPECT_LT((edge.at(1) - Vec3(0.5, 0, 0)).norm(), 1e-14);
  EXPECT_LT((edge.at(3.5) - Vec3(1, 0.5, 0)).norm(), 1e-14);
}

}  // namespace
}  // namespace polyslip::mesh
