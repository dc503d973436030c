#include "drivers/remeshing_attempts.hpp"

#include <gtest/gtest.h>

namespace polyslip::drivers {
namespace {

TEST(RemeshingAttempts, StartWithTheDeckAndGoOnWithEveryMesher) {
  Options o;
  o.mesh.meshers = {"netgen", "paper-1"};
  o.mesh.element_size = 0.5;
  o.mesh.outer_element_size = 1.0;
  o.mesh.grain_element_sizes = {0.4, 0.6};
  o.remeshing.orthotropic_share = 0.8;
  const auto attempts = remeshing_attempts(o);
  ASSERT_EQ(attempts.size(), 4u);
  EXPECT_EQ(attempts[0].meshing.meshers, o.mesh.meshers);
  EXPECT_EQ(attempts[0].meshing.element_size, 0.5);
  EXPECT_EQ(attempts[0].remeshing.orthotropic_share, 0.8);

  const std::vector<std::string> all{"netgen", "paper-1", "gmsh-hxt", "gmsh-delaunay"};
  EXPECT_EQ(attempts[1].meshing.meshers, all);
  EXPECT_EQ(attempts[1].meshing.mesher_target, 1);
  EXPECT_EQ(attempts[1].meshing.element_size, 0.5);

  EXPECT_NEAR(attempts[2].meshing.element_size, 0.4, 1e-15);
  EXPECT_NEAR(*attempts[2].meshing.outer_element_size, 0.8, 1e-15);
  EXPECT_NEAR(attempts[2].meshing.grain_element_sizes[1], 0.48, 1e-15);

  EXPECT_EQ(attempts[3].meshing.element_size, 0.5);
  EXPECT_EQ(attempts[3].remeshing.orthotropic_share, 0.4);
  for (const auto& a : attempts) EXPECT_FALSE(a.what.empty());
}

TEST(RemeshingAttempts, DropCarriedStressesFirst) {
  Options o;
  o.remeshing.transport.stress = "carried";
  const auto attempts = remeshing_attempts(o);
  ASSERT_EQ(attempts.size(), 5u);
  EXPECT_EQ(attempts[0].remeshing.transport.stress, "carried");
  EXPECT_EQ(attempts[1].meshing.mesher_target, o.mesh.mesher_target);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_EQ(attempts[i].remeshing.transport.stress, "zero");
  EXPECT_EQ(attempts[4].meshing.element_size, o.mesh.element_size);
}

TEST(RemeshingAttempts, LeaveOutAShareThatIsZeroAlready) {
  Options o;
  o.remeshing.orthotropic_share = 0;
  EXPECT_EQ(remeshing_attempts(o).size(), 3u);
}

}  // namespace
}  // namespace polyslip::drivers
