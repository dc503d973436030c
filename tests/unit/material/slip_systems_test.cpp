#include "material/slip_systems.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/rotation.hpp"

namespace {

using namespace polyslip;
using core::Vec3;
using material::SlipFamily;

constexpr double titanium = 1.587;  // c/a

int count_in_plane(const std::vector<material::SlipSystem>& systems, const Vec3& normal) {
  int count = 0;
  for (const auto& s : systems) {
    count += std::abs(std::abs(s.normal.dot(normal)) - 1) < 1e-12 ? 1 : 0;
  }
  return count;
}

struct Family {
  const char* name;
  SlipFamily family;
  std::size_t systems;
  int in_a_plane;
};

/// Counts of textbooks (Hosford, Mechanical Behavior of Materials; Kocks, Tome and Wenk 1998).
std::vector<Family> families() {
  const auto& cube = core::cubic_symmetries();
  const auto& prism = material::hexagonal_symmetries();
  const auto plane = [](double h, double k, double l) {
    return material::hexagonal_normal(h, k, l, titanium);
  };
  const auto along = [](double u, double v, double w) {
    return material::hexagonal_direction(u, v, w, titanium);
  };
  return {{"FCC {111}<110>", {Vec3(1, 1, 1), Vec3(0, 1, -1), cube}, 12, 3},
          {"BCC {110}<111>", {Vec3(1, 1, 0), Vec3(1, -1, 1), cube}, 12, 2},
          {"BCC {112}<111>", {Vec3(1, 1, 2), Vec3(1, 1, -1), cube}, 12, 1},
          {"BCC {123}<111>", {Vec3(1, 2, 3), Vec3(1, 1, -1), cube}, 24, 1},
          {"HCP basal {0001}<11-20>", {plane(0, 0, 1), along(1, 1, 0), prism}, 3, 3},
          {"HCP prismatic {10-10}<11-20>", {plane(1, 0, 0), along(-1, 2, 0), prism}, 3, 1},
          {"HCP pyramidal {10-11}<11-20>", {plane(1, 0, 1), along(-1, 2, 0), prism}, 6, 1},
          {"HCP pyramidal {10-11}<11-23>", {plane(1, 0, 1), along(-2, 1, 3), prism}, 12, 2},
          {"HCP pyramidal {11-22}<11-23>", {plane(1, 1, 2), along(-1, -1, 3), prism}, 6, 1}};
}

TEST(SlipSystems, FamiliesHaveTheirNumbers) {
  for (const auto& f : families()) {
    const auto systems = material::slip_systems(f.family);
    EXPECT_EQ(systems.size(), f.systems) << f.name;
    for (const auto& s : systems) {
      EXPECT_NEAR(s.normal.norm(), 1.0, 1e-15) << f.name;
      EXPECT_NEAR(s.direction.norm(), 1.0, 1e-15) << f.name;
      EXPECT_NEAR(s.normal.dot(s.direction), 0.0, 1e-15) << f.name;
      EXPECT_EQ(count_in_plane(systems, s.normal), f.in_a_plane) << f.name;
    }
  }
}

TEST(SlipSystems, DoNotDependOnTheMemberThatStandsForTheFamily) {
  for (const auto& f : families()) {
    const auto systems = material::slip_systems(f.family);
    for (const auto& member : systems) {
      const auto again =
          material::slip_systems({-3 * member.normal, member.direction, f.family.rotations});
      ASSERT_EQ(again.size(), systems.size()) << f.name;
      for (std::size_t a = 0; a < systems.size(); ++a) {
        EXPECT_LT((again[a].normal - systems[a].normal).norm(), 1e-14) << f.name;
        EXPECT_LT((again[a].direction - systems[a].direction).norm(), 1e-14) << f.name;
      }
    }
  }
}

TEST(SlipSystems, FccInTheDocumentedOrder) {
  const Vec3 expected[12][2] = {
      {{1, 1, 1}, {0, 1, -1}},   {{1, 1, 1}, {1, 0, -1}},  {{1, 1, 1}, {1, -1, 0}},
      {{1, 1, -1}, {0, 1, 1}},   {{1, 1, -1}, {1, 0, 1}},  {{1, 1, -1}, {1, -1, 0}},
      {{1, -1, 1}, {0, 1, 1}},   {{1, -1, 1}, {1, 0, -1}}, {{1, -1, 1}, {1, 1, 0}},
      {{1, -1, -1}, {0, 1, -1}}, {{1, -1, -1}, {1, 0, 1}}, {{1, -1, -1}, {1, 1, 0}}};
  const auto systems = material::fcc_slip_systems();
  ASSERT_EQ(systems.size(), 12U);
  for (std::size_t a = 0; a < 12; ++a) {
    EXPECT_LT((systems[a].normal - expected[a][0].normalized()).norm(), 1e-15) << a;
    EXPECT_LT((systems[a].direction - expected[a][1].normalized()).norm(), 1e-15) << a;
  }
}

TEST(SlipSystems, HexagonalRotationsAreAGroup) {
  const auto& all = material::hexagonal_symmetries();
  for (const auto& a : all) {
    EXPECT_NEAR(a.norm(), 1.0, 1e-15);
    int found = 0;
    for (const auto& b : all) {
      for (const auto& c : all) found += std::abs((a * b).dot(c)) > 1 - 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(found, 12);  // each product is one of them
  }
  EXPECT_EQ(all[0].w(), 1.0);
}

TEST(SlipSystems, HexagonalIndicesAreThoseOfTheLattice) {
  // a plane holds a direction where h u + k v + i t + l w = 0; [11-20] is 3 a long, [0001] c
  EXPECT_NEAR(material::hexagonal_direction(1, 1, 0, titanium).norm(), 3.0, 1e-14);
  EXPECT_NEAR(material::hexagonal_direction(0, 0, 1, titanium).norm(), titanium, 1e-15);
  // spacing of (10-11): 1/|normal|, d^-2 = 4/3 (h^2 + hk + k^2)/a^2 + l^2/c^2
  EXPECT_NEAR(material::hexagonal_normal(1, 0, 1, titanium).squaredNorm(),
              4.0 / 3 + 1 / (titanium * titanium), 1e-14);
  // (1 2 -3 1) . [2 -1 -1 2] = h u + k v + i t + l w = 2 - 2 + 3 + 2
  EXPECT_NEAR(material::hexagonal_normal(1, 2, 1, titanium)
                  .dot(material::hexagonal_direction(2, -1, 2, titanium)),
              5.0, 1e-14);
}

TEST(SlipSystems, ADirectionOutOfThePlaneIsRefused) {
  EXPECT_THROW(material::slip_systems({Vec3(1, 1, 1), Vec3(1, 1, 0), core::cubic_symmetries()}),
               core::InternalError);
  EXPECT_THROW(material::slip_systems({Vec3(1, 1, 1), Vec3(0, 0, 0), core::cubic_symmetries()}),
               core::InternalError);
}

}  // namespace
