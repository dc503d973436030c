// Statistics of Voronoi tessellations and of their regularisation against Quey, Dawson, Barbe
// (2011), figs. 6 and 7, and against one tessellation of Neper 4.10.2. Inner grains are those
// without a face on the domain boundary.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "mesh/tessellation.hpp"
#include "mesh/volume_change.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

struct InnerMeans {
  long cells = 0;
  double faces = 0, edges = 0, vertices = 0;

  void add(const Tessellation& tessellation) {
    const auto& t = tessellation.topology;
    for (const auto& cell : t.cell_faces) {
      if (std::any_of(cell.begin(), cell.end(), [&](int f) { return t.faces[f].domain_face >= 0; }))
        continue;
      std::set<int> e, v;
      for (const int f : cell) {
        e.insert(t.faces[f].edges.begin(), t.faces[f].edges.end());
        for (const int i : t.face_vertices(f)) v.insert(i);
      }
      ++cells;
      faces += static_cast<double>(cell.size());
      edges += static_cast<double>(e.size());
      vertices += static_cast<double>(v.size());
    }
  }
  double mean_faces() const { return faces / static_cast<double>(cells); }
  double mean_edges() const { return edges / static_cast<double>(cells); }
  double mean_vertices() const { return vertices / static_cast<double>(cells); }
};

PolycrystalOptions cube(int grains, std::uint64_t seed) {
  PolycrystalOptions options;
  options.grains = grains;
  options.seed = seed;
  return options;
}

RegularisationOptions as_in_the_paper() { return RegularisationOptions{}.as_in_the_paper(); }

/// Flatness faults [degrees] of all faces, undistorted ones and those of the domain included, as
/// the caption of fig. 6 says; each face counts once.
struct Faults {
  std::vector<double> values;

  void add(const Tessellation& t) {
    for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f)
      values.push_back(flatness_fault(t, f));
  }
  double share_below(double degrees) const {
    const auto n =
        std::count_if(values.begin(), values.end(), [&](double f) { return f < degrees; });
    return static_cast<double>(n) / static_cast<double>(values.size());
  }
  double largest() const { return *std::max_element(values.begin(), values.end()); }
};

TEST(PolycrystalStatistics, RegularisationOfTenCubesOfAThousandGrains) {
  InnerMeans raw, paper, ours;
  Faults paper_faults, our_faults;
  for (int seed = 1; seed <= 10; ++seed) {
    const auto t = voronoi_tessellation(cube(1000, seed));
    raw.add(t);
    auto p = t;
    regularise(p, as_in_the_paper());
    p.check();
    paper.add(p);
    paper_faults.add(p);
    auto q = t;
    regularise(q, {});
    q.check();
    ours.add(q);
    our_faults.add(q);
  }
  ASSERT_GT(raw.cells, 4000);
  RecordProperty("raw_faces", std::to_string(raw.mean_faces()));
  RecordProperty("paper_faces", std::to_string(paper.mean_faces()));
  RecordProperty("ours_faces", std::to_string(ours.mean_faces()));
  RecordProperty("ours_edges", std::to_string(ours.mean_edges()));
  EXPECT_NEAR(raw.mean_faces(), 15.1, 0.2);
  EXPECT_NEAR(raw.mean_edges(), 39.1, 0.4);
  EXPECT_NEAR(paper.mean_faces(), 13.7, 0.1);
  EXPECT_NEAR(paper.mean_edges(), 31.8, 0.2);
  EXPECT_NEAR(ours.mean_faces(), 13.7, 0.2);
  EXPECT_NEAR(ours.mean_edges(), 31.8, 0.8);  // more of the short edges go than in the paper

  // Fig. 6: between 0 and 20 degrees, 90 % of them below 6. By the paper's rules alone it is 87 %,
  // as in a tessellation of Neper's (89 %).
  RecordProperty("paper_below_6", std::to_string(paper_faults.share_below(6)));
  RecordProperty("ours_below_6", std::to_string(our_faults.share_below(6)));
  EXPECT_NEAR(paper_faults.share_below(6), 0.875, 0.01);
  EXPECT_GT(our_faults.share_below(6), 0.9);
  EXPECT_LT(our_faults.share_below(0.5), 0.6);
  EXPECT_LE(paper_faults.largest(), 20 + 1e-9);
  EXPECT_LE(our_faults.largest(), 20 + 1e-9);
}

// Each vertex of a Poisson-Voronoi cell has three edges, so V = 2 F - 4 and E = 3 F - 6; the mean
// number of faces of inner grains rises towards 2 + 48 pi^2 / 35 = 15.5355 with the cube's size.
TEST(PolycrystalStatistics, PoissonVoronoiMeansRiseWithTheCube) {
  const auto mean_of = [](int grains, int cubes) {
    InnerMeans means;
    for (int seed = 1; seed <= cubes; ++seed)
      means.add(voronoi_tessellation(cube(grains, 100 + seed)));
    EXPECT_NEAR(means.mean_edges(), 3 * means.mean_faces() - 6, 1e-9);
    EXPECT_NEAR(means.mean_vertices(), 2 * means.mean_faces() - 4, 1e-9);
    return means.mean_faces();
  };
  EXPECT_NEAR(mean_of(150, 100), 14.35, 0.2);
  EXPECT_NEAR(mean_of(500, 20), 14.81, 0.2);
  EXPECT_NEAR(mean_of(10000, 1), 15.32, 0.2);
}

// Without a boundary there is no bias by the number of grains. Tessellations are independent: the
// standard error of the mean is that between them.
TEST(PolycrystalStatistics, PeriodicPoissonVoronoiMeans) {
  const int count = 20, grains = 500;
  std::vector<double> faces;
  double mean = 0;
  for (int seed = 1; seed <= count; ++seed) {
    auto options = cube(grains, 200 + seed);
    options.periodic = {true, true, true};
    InnerMeans means;
    means.add(voronoi_tessellation(options));
    ASSERT_EQ(means.cells, grains);
    EXPECT_NEAR(means.mean_edges(), 3 * means.mean_faces() - 6, 1e-9);
    faces.push_back(means.mean_faces());
    mean += faces.back() / count;
  }
  double variance = 0;
  for (const double f : faces) variance += (f - mean) * (f - mean) / (count - 1);
  const double error = std::sqrt(variance / count);
  RecordProperty("faces", std::to_string(mean));
  RecordProperty("error", std::to_string(error));
  EXPECT_LT(error, 0.03);
  EXPECT_NEAR(mean, 2 + 48 * M_PI * M_PI / 35, 3 * error);
}

// Fig. 7, 100,000 grains. The least-squares position alone refuses too many edges for flatness from
// l_max = 0.39 on (11.8 and 11.4 faces). Grains' volumes change by no more than half as much again
// as by the paper's rules, which delete fewer edges.
void expect_faces_of_figure_7(int cubes) {
  const double lengths[] = {0.13, 0.26, 0.39, 0.52}, paper[] = {13.7, 12.3, 11.1, 10.2};
  for (int i = 0; i < 4; ++i) {
    RegularisationOptions options;
    options.max_edge_length = lengths[i];
    InnerMeans ours, papers;
    double our_change = 0, papers_change = 0;
    for (int seed = 1; seed <= cubes; ++seed) {
      auto t = voronoi_tessellation(cube(1000, seed));
      auto p = t;
      const auto volumes = cell_volumes(t);
      regularise(t, options);
      our_change += volume_change(volumes, cell_volumes(t)).rms / cubes;
      t.check();
      ours.add(t);
      regularise(p, options.as_in_the_paper());
      papers_change += volume_change(volumes, cell_volumes(p)).rms / cubes;
      papers.add(p);
    }
    const std::string at = std::to_string(i);
    testing::Test::RecordProperty("ours_faces_" + at, std::to_string(ours.mean_faces()));
    testing::Test::RecordProperty("paper_faces_" + at, std::to_string(papers.mean_faces()));
    testing::Test::RecordProperty("ours_volumes_" + at, std::to_string(our_change));
    testing::Test::RecordProperty("paper_volumes_" + at, std::to_string(papers_change));
    EXPECT_NEAR(ours.mean_faces(), paper[i], i == 0 ? 0.2 : 0.3) << lengths[i];
    EXPECT_GT(papers.mean_faces(), ours.mean_faces());
    EXPECT_GT(our_change, 0.01);
    EXPECT_LT(our_change, 1.6 * papers_change);
  }
}

TEST(PolycrystalStatistics, LargerLengthsTakeMoreFaces) { expect_faces_of_figure_7(2); }
TEST(PolycrystalStatistics, SlowLargerLengthsTakeMoreFacesInTenCubes) {
  expect_faces_of_figure_7(10);
}

// Fig. 5: short edges become fewer with f_max, and hardly any more go beyond 20 degrees.
TEST(PolycrystalStatistics, FlatnessFaultsFromZeroTo45Degrees) {
  const double faults[] = {0, 5, 10, 20, 30, 45};
  const auto raw = voronoi_tessellation(cube(1000, 1));
  for (const bool as_paper : {true, false}) {
    std::vector<double> shares;
    for (const double fault : faults) {
      RegularisationOptions options;
      if (as_paper) options = options.as_in_the_paper();
      options.max_flatness_fault = fault;
      auto t = raw;
      const auto report = regularise(t, options);
      t.check();
      EXPECT_LE(report.max_flatness_fault, fault + 1e-6);  // rounding of flat faces
      shares.push_back(static_cast<double>(report.short_after) / report.edges_before);
    }
    EXPECT_NEAR(shares.front(), 0.173, 0.01);  // all edges; 0.194 of those of inner grains
    for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_LT(shares[i], shares[i - 1] + 1e-3);
    EXPECT_LT(shares[3], 0.2 * shares[0]);   // 20 degrees
    EXPECT_LT(shares[3] - shares[5], 0.02);  // little is left to gain
    EXPECT_GT(shares[1] - shares[3], 0.05);  // 5 degrees are too few
  }
}

// The seeds of Neper 4.10.2 for `-n 100 -id 1` (results only) and what it made of them.
TEST(PolycrystalStatistics, NepersHundredGrains) {
  std::ifstream file(POLYSLIP_SOURCE_DIR "/tests/verification/mesh/data/neper_n100_seeds.txt");
  std::vector<Vec3> seeds;
  for (Vec3 x; file >> x[0] >> x[1] >> x[2];) seeds.push_back(x);
  ASSERT_EQ(seeds.size(), 100U);
  auto t = voronoi_tessellation(seeds, Vec3::Constant(std::cbrt(100)));
  EXPECT_EQ(t.topology.vertex_count, 575);
  EXPECT_EQ(t.topology.edges.size(), 1146U);
  EXPECT_EQ(t.topology.faces.size(), 672U);

  const auto report = regularise(t, as_in_the_paper());
  t.check();
  EXPECT_EQ(report.short_before, 171);
  InnerMeans means;
  means.add(t);
  EXPECT_EQ(means.cells, 21);
  EXPECT_NEAR(means.mean_faces(), 13.9048, 0.1);  // 292 faces
  EXPECT_NEAR(means.mean_edges(), 32.4762, 0.3);
  EXPECT_NEAR(t.topology.vertex_count, 449, 10);
  EXPECT_NEAR(static_cast<double>(t.topology.faces.size()), 628, 6);
  EXPECT_NEAR(report.max_flatness_fault, 19.93, 0.07);
}

}  // namespace
}  // namespace polyslip::mesh
