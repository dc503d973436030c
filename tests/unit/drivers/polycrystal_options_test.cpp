// [polycrystal]: keys of some bodies and morphologies only.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.hpp"
#include "drivers/options.hpp"

namespace polyslip::drivers {
namespace {

mesh::PolycrystalOptions read(const std::string& keys, Purpose purpose = Purpose::mesh) {
  core::Deck deck = core::Deck::from_text("[polycrystal]\n" + keys, "deck.toml");
  const auto options = read_options(deck, purpose).polycrystal;
  // What was understood reads back to the same.
  core::Deck again = core::Deck::from_text(deck.resolved(), "deck.toml");
  const auto twice = read_options(again, purpose).polycrystal;
  EXPECT_EQ(options.grains, twice.grains);
  EXPECT_EQ(options.shape, twice.shape);
  EXPECT_EQ(options.axis, twice.axis);
  EXPECT_EQ(options.faceting_error, twice.faceting_error);
  EXPECT_EQ(options.half_spaces, twice.half_spaces);
  EXPECT_EQ(options.morphology, twice.morphology);
  EXPECT_EQ(options.columnar_share, twice.columnar_share);
  EXPECT_EQ(options.cells, twice.cells);
  return options;
}

TEST(PolycrystalOptions, KeysOfBodiesReachThem) {
  const auto cylinder = read("shape = \"cylinder\"\naxis = \"y\"\nfaceting_error = 0.05\n");
  EXPECT_EQ(cylinder.shape, "cylinder");
  EXPECT_EQ(cylinder.axis, 1);
  EXPECT_EQ(cylinder.faceting_error, 0.05);
  const auto tetrahedron = read(
      "shape = \"half-spaces\"\n"
      "half_spaces = [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [1, 1.5, 1, 1]]\n");
  ASSERT_EQ(tetrahedron.half_spaces.size(), 4u);
  EXPECT_EQ(tetrahedron.half_spaces[3], (std::array<double, 4>{1, 1.5, 1, 1}));
}

TEST(PolycrystalOptions, KeysOfMorphologiesReachThem) {
  const auto casting = read(
      "morphology = \"columnar-equiaxed\"\naxis = \"x\"\ncolumnar_share = 0.3\n", Purpose::run);
  EXPECT_EQ(casting.morphology, mesh::Morphology::columnar_equiaxed);
  EXPECT_EQ(casting.axis, 0);
  EXPECT_EQ(casting.columnar_share, 0.3);
  const auto regular = read("morphology = \"truncated-octahedra\"\ncells = [2, 3, 4]\n");
  EXPECT_EQ(regular.morphology, mesh::Morphology::truncated_octahedra);
  ASSERT_TRUE(regular.cells.has_value());
  EXPECT_EQ(*regular.cells, (std::array<int, 3>{2, 3, 4}));
  EXPECT_EQ(regular.grains, 48);
}

TEST(PolycrystalOptions, WhatIsUnderstoodReadsBackWithKeysThatExcludeStretching) {
  EXPECT_EQ(read("morphology = \"grain-growth\"\n").morphology, mesh::Morphology::grain_growth);
  EXPECT_EQ(read("morphology = \"laguerre\"\ndiameter_deviation = 0.3\n").morphology,
            mesh::Morphology::laguerre);
  EXPECT_TRUE(read("periodic = [\"x\"]\n").periodic[0]);
  EXPECT_THROW(read("periodic = [\"x\"]\nstretch = [2, 1, 1]\n"), core::InputError);
  EXPECT_THROW(read("morphology = \"laguerre\"\nstretch = [2, 1, 1]\n"), core::InputError);
}

TEST(PolycrystalOptions, EveryInputReadsBack) {
  int decks = 0;
  for (const auto& entry : std::filesystem::directory_iterator(POLYSLIP_SOURCE_DIR "/inputs")) {
    if (entry.path().extension() != ".toml") continue;
    core::Deck deck = core::Deck::from_file(entry.path().string());
    read_options(deck, Purpose::mesh);
    core::Deck again = core::Deck::from_text(deck.resolved(), entry.path().string());
    EXPECT_NO_THROW(read_options(again, Purpose::mesh)) << entry.path();
    EXPECT_EQ(again.resolved(), deck.resolved());
    ++decks;
  }
  EXPECT_GT(decks, 20);
}

TEST(PolycrystalOptions, DefaultsAreABoxOfRandomSeeds) {
  const auto o = read("");
  EXPECT_EQ(o.shape, "box");
  EXPECT_EQ(o.morphology, mesh::Morphology::voronoi);
  EXPECT_EQ(o.axis, 2);
  EXPECT_EQ(o.faceting_error, 0.01);
  EXPECT_FALSE(o.cells.has_value());
}

}  // namespace
}  // namespace polyslip::drivers
