#include "mesh/candidate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "surfaces.hpp"

namespace polyslip::mesh {
namespace {

TEST(Candidates, AreGoodIfTheyReachWhatTheirSurfaceAllows) {
  // Equilateral triangles of edge 0.5: O = 1 is allowed.
  const auto regular = test::ellipsoid_surface(0, core::Vec3::Constant(0.5 / std::sqrt(2.0)));
  const auto bounds = surface_bounds(regular, 0.5);
  EXPECT_EQ(bounds.floor, 0.2);
  EXPECT_NEAR(bounds.O, 1, 0.01);
  EXPECT_LT(surface_bounds(regular, 2.0).O, 0.5);
  EXPECT_TRUE(is_good(bounds, 0.3, 0.95, 0.9));
  EXPECT_FALSE(is_good(bounds, 0.1, 0.95, 0.9));
  EXPECT_FALSE(is_good(bounds, 0.3, 0.85, 0.9));
  EXPECT_FALSE(is_good(bounds, std::nan(""), 0.95, 0.9));
  EXPECT_FALSE(is_good(bounds, 0.3, std::nan(""), 0.9));
  // A needle: the floor goes down with it.
  SurfaceMesh needle{{{0, 0, 0}, {1, 0, 0}, {1, 0.03, 0}, {1, 0, 0.5}},
                     {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_LT(surface_bounds(needle, 0.5).floor, 0.05);
  EXPECT_GT(surface_bounds(needle, 0.5).floor, 0.01);
}

TEST(Candidates, RaiseAPresentMeshForABetterWorstElement) {
  const MeshQuality present{0.25, 0.95};
  EXPECT_TRUE(raises({0.26, 0.9}, present));
  EXPECT_FALSE(raises({0.252, 0.99}, present)) << "too little";
  EXPECT_FALSE(raises({0.29, 0.85}, present)) << "too little O";
  EXPECT_FALSE(raises({std::nan(""), 0.95}, present));
}

TEST(Candidates, OneGrainInAHundredMayBeRaised) {
  std::vector<double> worst(150, 0.4), bounds(150, 0.0);
  EXPECT_TRUE(worst_grains(worst, bounds).empty());
  for (const int grain : {7, 20, 90}) bounds[grain] = 0.3;
  worst[7] = 0.28, worst[20] = 0.27, worst[90] = 0.25;
  EXPECT_EQ(worst_grains(worst, bounds), (std::vector<int>{90, 20}));
  worst[90] = 0.295;
  EXPECT_EQ(worst_grains(worst, bounds), (std::vector<int>{20, 7})) << "90 is at its bound";
  EXPECT_EQ(worst_grains({0.2}, {0.3}), std::vector<int>{0});
}

TEST(Candidates, ReplaceAPresentMeshForABetterOOrASliver) {
  const MeshQuality present{0.17, 0.93};
  EXPECT_TRUE(replaces({0.17, 0.94}, present));
  EXPECT_FALSE(replaces({0.3, 0.99}, {0.4, 0.93}));
  EXPECT_TRUE(replaces({0.6, 0.94}, present));
  EXPECT_FALSE(replaces(present, present));
  EXPECT_FALSE(replaces({0.3, 0.92}, present))
      << "O must not fall for an element that is no sliver";
  EXPECT_FALSE(replaces({0.12, 0.94}, present)) << "nor the worst element";
  const MeshQuality sliver{0.05, 0.93};
  EXPECT_TRUE(replaces({0.15, 0.85}, sliver));
  EXPECT_TRUE(replaces({0.07, 0.85}, sliver));
  EXPECT_FALSE(replaces({0.03, 0.99}, sliver));
  EXPECT_FALSE(replaces({0.03, 0.99}, present));
}

TEST(Candidates, OfAGrainWhoseNodesHaveSlidCompareTheWorstElementUpToThreeTenths) {
  EXPECT_GT(rank_of_slid(0.29, 0.9), rank_of_slid(0.25, 0.95));
  EXPECT_GT(rank_of_slid(0.31, 0.95), rank_of_slid(0.5, 0.94));
  EXPECT_GT(rank_of_slid(0.281, 0.95), rank_of_slid(0.299, 0.94)) << "in steps";
  EXPECT_GT(rank_of(0.25, 0.95), rank_of(0.29, 0.9));
}

}  // namespace
}  // namespace polyslip::mesh
