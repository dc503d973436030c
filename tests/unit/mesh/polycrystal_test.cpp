#include "mesh/polycrystal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using std::numbers::pi;

double volume_of(const Tessellation& t) {
  double sum = 0;
  for (int c = 0; c < t.topology.cell_count(); ++c) sum += cell_volume(t, c);
  return sum;
}

/// Sound before and after regularisation, with the volume asked for.
Tessellation expect_sound(const PolycrystalOptions& options, int grains) {
  Tessellation t = voronoi_tessellation(options);
  t.check();
  EXPECT_EQ(t.topology.cell_count(), grains);
  EXPECT_NEAR(t.domain.volume / grains, 1, 1e-12);
  EXPECT_NEAR(volume_of(t) / grains, 1, 1e-12);
  Tessellation regular = t;
  regularise(regular, {});
  regular.check();
  EXPECT_NEAR(volume_of(regular) / grains, 1, 1e-12);
  return t;
}

/// Grains that neither touch the domain's boundary nor a grain that does, by their number of faces.
std::map<int, int> faces_of_inner_grains(const Tessellation& t) {
  std::map<int, int> counts;
  const auto touches = [&](int cell) {
    const auto& faces = t.topology.cell_faces[cell];
    return std::any_of(faces.begin(), faces.end(),
                       [&](int f) { return t.topology.faces[f].domain_face >= 0; });
  };
  for (const auto& faces : t.topology.cell_faces) {
    bool inner = true;
    for (const int f : faces)
      for (const int c : t.topology.faces[f].cells) inner = inner && c >= 0 && !touches(c);
    if (inner) ++counts[static_cast<int>(faces.size())];
  }
  return counts;
}

TEST(Polycrystal, ACylinderIsTheFewestSidesWithinItsError) {
  PolycrystalOptions o{.grains = 50, .domain = {1, 1, 2}, .shape = "cylinder"};
  for (const double error : {0.1, 1e-2, 2e-3}) {
    o.faceting_error = error;
    const Domain d = polycrystal_domain(o);
    const int n = d.face_count() - 2;
    const auto excess = [](int sides) { return sides * std::tan(pi / sides) / pi - 1; };
    EXPECT_LE(excess(n), error);
    EXPECT_TRUE(n == 6 || excess(n - 1) > error) << n;
    EXPECT_NEAR(d.faceting_error, excess(n), 1e-14);
    // The true cylinder of that diameter and height.
    const double height = d.size[2], diameter = height / 2;
    EXPECT_NEAR(d.volume / (pi / 4 * diameter * diameter * height), 1 + d.faceting_error, 1e-12);
    EXPECT_EQ(d.surface_names(), (std::vector<std::string>{"z0", "z1", "side"}));
  }
  for (const int axis : {0, 1, 2}) {
    o.axis = axis;
    o.domain = {1, 1.5, 2};
    expect_sound(o, 50);
    EXPECT_NEAR(polycrystal_domain(o).size[axis] / o.domain[axis], polycrystal_domain(o).scale,
                1e-12);
  }
}

TEST(Polycrystal, ASphereIsWithinItsError) {
  for (const Vec3& extents : {Vec3(1, 1, 1), Vec3(1, 2, 3)}) {
    PolycrystalOptions o{.grains = 60, .domain = extents, .shape = "sphere"};
    o.faceting_error = 0.03;
    const Domain d = polycrystal_domain(o);
    const double true_volume = pi / 6 * (d.scale * extents).prod();
    EXPECT_NEAR(d.volume / true_volume, 1 + d.faceting_error, 1e-12);
    EXPECT_LE(d.faceting_error, 0.03);
    EXPECT_GT(d.faceting_error, 0.02);
    EXPECT_EQ(d.edges.size(), 3u * (d.vertices.size() / 2));  // three facets a corner
    EXPECT_EQ(d.surface_names(), (std::vector<std::string>{"surface"}));
    // Evenly spread: no facet's edge is a splinter.
    double shortest = 1e9, sum = 0;
    for (const auto& e : d.edges) {
      const double length = (d.vertices[e.vertices[0]] - d.vertices[e.vertices[1]]).norm();
      shortest = std::min(shortest, length);
      sum += length / static_cast<double>(d.edges.size());
    }
    if (extents == Vec3(1, 1, 1)) {
      EXPECT_GT(shortest, 0.6 * sum);
    }
    expect_sound(o, 60);
  }
}

TEST(Polycrystal, AnyShapeTakesOneGrainOrTwo) {
  for (const char* shape : {"box", "cylinder", "sphere"})
    for (const int grains : {1, 2, 3}) {
      PolycrystalOptions o{.grains = grains, .shape = shape};
      o.faceting_error = 0.1;
      expect_sound(o, grains);
    }
}

TEST(Polycrystal, HalfSpacesAreScaled) {
  PolycrystalOptions o{.grains = 20, .shape = "half-spaces"};
  o.half_spaces = {{-1, 0, 0, 0}, {0, -2, 0, 0}, {0, 0, -1, 0}, {1, 1, 1, 1}};
  const auto t = expect_sound(o, 20);
  EXPECT_EQ(t.domain.surface_names(), (std::vector<std::string>{"f1", "f2", "f3", "f4"}));
  EXPECT_EQ(t.domain.vertices.size(), 4u);
}

TEST(Polycrystal, ColumnsRunFromEndToEnd) {
  for (const int axis : {0, 2}) {
    PolycrystalOptions o{.grains = 40, .domain = {1, 2, 1}, .axis = axis};
    o.morphology = Morphology::columnar;
    const auto t = expect_sound(o, 40);
    std::vector<int> ends(40, 0);
    for (std::size_t f = 0; f < t.topology.faces.size(); ++f) {
      const auto& face = t.topology.faces[f];
      if (face.domain_face / 2 == axis && face.domain_face >= 0) ++ends[face.cells[0]];
      EXPECT_LT(std::abs(std::abs(t.face_planes[f].normal[axis]) - 0.5), 0.5 + 1e-12);
      if (face.domain_face < 0) {
        EXPECT_NEAR(t.face_planes[f].normal[axis], 0, 1e-12);
      }
    }
    EXPECT_EQ(ends, std::vector<int>(40, 2));
  }
}

TEST(Polycrystal, BambooIsSlabsOfComparableThickness) {
  PolycrystalOptions o{.grains = 12, .domain = {6, 1, 1}, .shape = "cylinder", .axis = 0};
  o.morphology = Morphology::bamboo;
  o.faceting_error = 0.05;
  const auto t = expect_sound(o, 12);
  int inner = 0;
  for (const auto& face : t.topology.faces) inner += face.domain_face < 0;
  EXPECT_EQ(inner, 11);
  for (int c = 0; c < 12; ++c) EXPECT_GT(cell_volume(t, c), 0.2);
}

TEST(Polycrystal, ColumnsEndWhereEquiaxedGrainsBegin) {
  PolycrystalOptions o{.grains = 300, .domain = {1, 1, 1.5}};
  o.morphology = Morphology::columnar_equiaxed;
  o.columnar_share = 0.6;
  const auto t = expect_sound(o, 300);
  // Grains at the low end are columns; together they fill about the share that was asked for.
  double columns = 0;
  int count = 0;
  std::vector<char> low(300, false), high(300, false);
  for (const auto& face : t.topology.faces) {
    if (face.domain_face == 4) low[face.cells[0]] = true;
    if (face.domain_face == 5) high[face.cells[0]] = true;
  }
  for (int c = 0; c < 300; ++c) {
    EXPECT_FALSE(low[c] && high[c]);
    if (low[c]) columns += cell_volume(t, c), ++count;
  }
  EXPECT_NEAR(columns / 300, 0.6, 0.05);
  EXPECT_GT(count, 30);
  EXPECT_LT(count, 150);
  o.grains = 1;
  EXPECT_THROW(voronoi_tessellation(o), core::InputError);
  o.grains = 2;
  expect_sound(o, 2);
}

TEST(Polycrystal, RegularSeedsGiveTheirPolyhedra) {
  PolycrystalOptions o;
  o.cells = {{6, 6, 6}};
  const std::map<Morphology, std::array<int, 2>> cases{
      {Morphology::cubes, {216, 6}},
      {Morphology::truncated_octahedra, {432, 14}},
      {Morphology::rhombic_dodecahedra, {864, 12}}};
  for (const auto& [morphology, expected] : cases) {
    o.morphology = morphology;
    EXPECT_EQ(regular_grain_count(o), expected[0]);
    const auto t = expect_sound(o, expected[0]);
    const auto counts = faces_of_inner_grains(t);
    ASSERT_EQ(counts.size(), 1u);
    EXPECT_EQ(counts.begin()->first, expected[1]);
    EXPECT_GE(counts.begin()->second, 8);
  }
}

TEST(Polycrystal, AGridIsFoundFromGrainsIfThereIsOne) {
  PolycrystalOptions o{.grains = 2 * 4 * 2 * 2, .domain = {2, 1, 1}};
  o.morphology = Morphology::truncated_octahedra;
  EXPECT_EQ(grid_of(o), (std::array<int, 3>{4, 2, 2}));
  expect_sound(o, 32);
  o.grains = 30;
  try {
    voronoi_tessellation(o);
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("cells = [4, 2, 2] (32 grains)"), std::string::npos)
        << e.what();
  }
  o.grains = 32;
  o.shape = "sphere";
  EXPECT_THROW(voronoi_tessellation(o), core::InputError);
}

/// Mean over grains of the extent along an axis.
Vec3 mean_extents(const Tessellation& t) {
  Vec3 sum = Vec3::Zero();
  for (const auto& faces : t.topology.cell_faces) {
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (const int f : faces)
      for (const int v : t.topology.face_vertices(f)) {
        low = low.cwiseMin(t.vertices[v]);
        high = high.cwiseMax(t.vertices[v]);
      }
    sum += high - low;
  }
  return sum / static_cast<double>(t.topology.cell_count());
}

TEST(Polycrystal, StretchedGrainsAreLongerByItsFactors) {
  // The domain stretched likewise: the same cells as without, seen stretched.
  PolycrystalOptions o{.grains = 60, .domain = {1, 1, 1}};
  const Vec3 plain = mean_extents(expect_sound(o, 60));
  o.stretch = {4, 1, 2};
  o.domain = o.stretch;
  const Vec3 longer = mean_extents(expect_sound(o, 60));
  const Vec3 factors = o.stretch / 2;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(longer[i] / plain[i], factors[i], 1e-9);
  // In a cube the ratios of mean extents come near the factors.
  o.domain = {1, 1, 1};
  o.grains = 4000;
  const Vec3 cube = mean_extents(voronoi_tessellation(o));
  EXPECT_NEAR(cube[0] / cube[1], 4, 0.6);
  EXPECT_NEAR(cube[2] / cube[1], 2, 0.25);
  o = {.grains = 60, .shape = "sphere"};
  o.faceting_error = 0.1;
  o.stretch = {2, 1, 0.5};
  expect_sound(o, 60);
}

class SeedFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::path(testing::TempDir()) /
             ("polyslip-seeds-" + std::to_string(getpid()) + ".txt"))
                .string();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  void expect_refused(const std::string& text, const std::string& what) const {
    write(text);
    PolycrystalOptions o;
    try {
      read_seeds(path_, o);
      FAIL() << "accepted; expected: " << what;
    } catch (const core::InputError& e) {
      EXPECT_EQ(std::string(e.what()).find(path_), 0u) << e.what();
      EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
    }
  }
  std::string path_;
};

TEST_F(SeedFile, GivesTheSeedsInTheUnitOfTheDomain) {
  write("# two grains\n0.5 0.5 0.5\n\n 1.5 0.5 0.5 # the second\n");
  PolycrystalOptions o{.domain = {2, 1, 1}};
  read_seeds(path_, o);
  EXPECT_EQ(o.grains, 2);
  const auto t = expect_sound(o, 2);
  EXPECT_NEAR(cell_volume(t, 0), 1, 1e-12);
  EXPECT_LT((t.seeds[1] - Vec3(1.5, 0.5, 0.5)).norm(), 1e-12);
  o.stretch = {3, 1, 1};
  EXPECT_LT((expect_sound(o, 2).seeds[1] - Vec3(1.5, 0.5, 0.5)).norm(), 1e-12);
}

TEST_F(SeedFile, WhatIsNoSeedIsRefusedWithItsLine) {
  expect_refused("0.1 0.1 0.1\n0.2 0.2\n", ":2: 2 entries");
  expect_refused("0.1 0.1 0.1 0.1\n", ":1: 4 entries");
  expect_refused("0.1 0.1 0.1\n0.2 0.2 a\n", ":2: 'a' is no number");
  expect_refused("0.1 0.1 nan\n", ":1: 'nan' is no number");
  expect_refused("0.1 0.1 0.1\n\n0.2 0.2 1.2\n", ":3: seed 2 at (0.2, 0.2, 1.2) lies outside");
  expect_refused("0.1 0.1 0.1\n0.2 0.2 0.2\n0.1 0.1 0.1\n", ":3: seed 3 coincides with seed 1");
  expect_refused("# none\n", "holds no seed");
}

TEST(Polycrystal, ASheetOfTenThousandGrainsIsSound) {
  PolycrystalOptions o{.grains = 10'000, .domain = {100, 100, 1}};
  Tessellation t = voronoi_tessellation(o);
  regularise(t, {});
  t.check();
}

}  // namespace
}  // namespace polyslip::mesh
