// The keys of [loading] that only some types of load read.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "drivers/options.hpp"

namespace polyslip::drivers {
namespace {

Options read(const std::string& text) {
  core::Deck deck = core::Deck::from_text(text, "deck.toml");
  const Options o = read_options(deck);
  // What was understood reads back to the same.
  core::Deck again = core::Deck::from_text(deck.resolved(), "resolved.toml");
  read_options(again);
  EXPECT_EQ(deck.resolved(), again.resolved());
  EXPECT_EQ(deck.fingerprint(), again.fingerprint());
  return o;
}

TEST(Loading, AxesAndSides) {
  const auto o = read(
                     "[loading]\ntype = \"uniaxial-tension\"\ncontrol = \"constant-velocity\"\n"
                     "axis = \"x\"\nlateral = \"free\"\n")
                     .loading;
  EXPECT_EQ(o.type, "uniaxial-tension");
  EXPECT_EQ(o.control, "constant-velocity");
  EXPECT_EQ(o.axis, 0);
  EXPECT_EQ(o.lateral, "free");
  const auto shear =
      read("[loading]\ntype = \"simple-shear\"\naxis = \"y\"\ndirection = \"z\"\n").loading;
  EXPECT_EQ(shear.axis, 1);
  EXPECT_EQ(shear.direction, 2);
  EXPECT_EQ(read("[loading]\nconstrained_axis = \"x\"\n").loading.constrained_axis, 0);
}

TEST(Loading, GradientRowByRow) {
  const auto o = read(
                     "[loading]\ntype = \"velocity-gradient\"\n"
                     "velocity_gradient = [1, 2, 3, 4, 5, 6, 7, 8, -6]\n")
                     .loading;
  EXPECT_EQ(o.velocity_gradient(0, 1), 2);
  EXPECT_EQ(o.velocity_gradient(1, 0), 4);
  EXPECT_EQ(o.velocity_gradient(2, 2), -6);
}

TEST(Loading, FacesAndCorners) {
  const auto o =
      read(
          "[loading]\ntype = \"faces\"\nx0 = \"sliding\"\ny1 = \"planar\"\n"
          "y1_traction = -3\nz0 = \"fixed\"\nz1 = \"moving\"\nz1_velocity = [0, 0.5, 1]\n"
          "held = [\"x1y0z1:yz\"]\ntraction_strain = 0.01\n")
          .loading;
  EXPECT_EQ(o.faces[0].kind, "sliding");
  EXPECT_EQ(o.faces[1].kind, "free");
  EXPECT_EQ(o.faces[3].kind, "planar");
  EXPECT_EQ(o.faces[3].traction, -3);
  EXPECT_EQ(o.faces[5].velocity, core::Vec3(0, 0.5, 1));
  ASSERT_EQ(o.held.size(), 1u);
  EXPECT_EQ(o.held[0].sides, (std::array<int, 3>{1, 0, 1}));
  EXPECT_EQ(o.held[0].components, (std::array<bool, 3>{false, true, true}));
  EXPECT_EQ(o.traction_strain, 0.01);
}

TEST(Loading, StagesInTheirOrder) {
  const auto o = read(
                     "[loading]\nstrain_rate = 0.5\n[[loading.stage]]\nstrain = 0.1\n"
                     "[[loading.stage]]\nstrain_rate = -2\ntime = 0.25\nstress = 3\n"
                     "[remeshing]\nat_strains = [0.15]\n")
                     .loading;
  ASSERT_EQ(o.stages.size(), 2u);
  EXPECT_EQ(o.stages[0].strain_rate, 0.5);
  EXPECT_EQ(o.stages[0].strain, 0.1);
  EXPECT_FALSE(o.stages[0].time);
  EXPECT_EQ(o.stages[1].strain_rate, -2);
  EXPECT_EQ(o.stages[1].time, 0.25);
  EXPECT_EQ(o.stages[1].stress, 3);
}

}  // namespace
}  // namespace polyslip::drivers
