// Decks with a tessellation or a mesh made elsewhere.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "drivers/generate.hpp"
#include "drivers/orientations.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::drivers {
namespace {

const std::string tess = POLYSLIP_SOURCE_DIR "/tests/data/n20-id1-raw.tess";

class InputFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + fmt::format("polyslip_input_{}", ::getpid());
    core::make_folder(folder_);
    mesh::write_msh(tests::box_mesh({4, 2, 2}, {4, 2, 2}, 2), folder_ + "/slabs.msh");
    core::write_file(folder_ + "/turned.msh",
                     core::read_text(folder_ + "/slabs.msh") +
                         "$ElsetOrientations\n2 rodrigues:passive\n1 0.1 0.2 0.3\n2 0 0 0.2\n"
                         "$EndElsetOrientations\n");
    std::filesystem::copy_file(tess, folder_ + "/a.tess");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Options read(const std::string& text) {
    core::Deck deck = core::Deck::from_text(text, folder_ + "/deck.toml");
    Options options = read_options(deck, Purpose::mesh);
    // The deck as it was understood means the same.
    core::Deck again = core::Deck::from_text(deck.resolved(), folder_ + "/resolved.toml");
    read_options(again, Purpose::mesh);
    EXPECT_EQ(again.resolved(), deck.resolved());
    return options;
  }
  std::string error_of(const std::string& text) {
    try {
      read_input(read(text));
    } catch (const core::InputError& e) {
      std::string message = e.what();
      for (std::size_t at; (at = message.find(folder_ + "/")) != std::string::npos;)
        message.erase(at, folder_.size() + 1);
      return message;
    }
    return "no error";
  }

  std::string folder_;
};

TEST_F(InputFiles, ATessellationComesWithItsOrientationsAndUnregularised) {
  const Options options = read("[polycrystal]\nfile = \"a.tess\"\n");
  EXPECT_EQ(options.regularisation.max_edge_length, 0);
  const Input input = read_input(options);
  ASSERT_TRUE(input.tessellation);
  EXPECT_EQ(input.tessellation->tessellation.topology.cell_count(), 20);
  EXPECT_TRUE(input.orientations_of_input);
  ASSERT_EQ(input.orientations.size(), 20U);
  EXPECT_NEAR(core::to_rodrigues(input.orientations[0])[0], 0.072386045838, 1e-15);
  EXPECT_EQ(read("[polycrystal]\nfile = \"a.tess\"\n[regularisation]\nmax_edge_length = 0.2\n")
                .regularisation.max_edge_length,
            0.2);
}

TEST_F(InputFiles, AMeshComesInTheUnitThatIsAsked) {
  const Input grains = read_input(read("[mesh]\nfile = \"turned.msh\"\n"));
  const Input file = read_input(read("[mesh]\nfile = \"turned.msh\"\nlength_unit = \"file\"\n"));
  ASSERT_TRUE(grains.mesh && file.mesh);
  EXPECT_LT((grains.mesh->mesh.size - core::Vec3(2, 1, 1)).norm(), 1e-12);
  EXPECT_EQ(file.mesh->mesh.size, core::Vec3(4, 2, 2));
  ASSERT_EQ(file.orientations.size(), 2U);
  EXPECT_NEAR(core::to_rodrigues(file.orientations[1])[2], 0.2, 1e-15);
}

TEST_F(InputFiles, OrientationsAreUniformWhereTheFileHasNoneOrTheDeckSaysSo) {
  for (const char* deck : {"[mesh]\nfile = \"slabs.msh\"\n[polycrystal]\nseed = 7\n",
                           "[mesh]\nfile = \"turned.msh\"\n[polycrystal]\nseed = 7\n"
                           "[orientations]\ndistribution = \"uniform\"\n"}) {
    const Input input = read_input(read(deck));
    EXPECT_FALSE(input.orientations_of_input);
    ASSERT_EQ(input.orientations.size(), 2U);
    EXPECT_EQ(input.orientations[1].coeffs(), uniform_orientations(7, 2)[1].coeffs());
  }
}

TEST_F(InputFiles, WhatHasNoMeaningBesideAFileIsAFault) {
  EXPECT_EQ(error_of("[polycrystal]\nfile = \"a.tess\"\ngrains = 20\n"),
            "deck.toml:3:10: [polycrystal] grains is not used with [polycrystal] file; remove one "
            "of them");
  EXPECT_EQ(error_of("[polycrystal]\nfile = \"a.tess\"\n[mesh]\nfile = \"slabs.msh\"\n"),
            "deck.toml:2:8: [polycrystal] file is not used with [mesh] file; remove one of them");
  EXPECT_EQ(
      error_of("[regularisation]\nmax_edge_length = 0.1\n[mesh]\nfile = \"slabs.msh\"\n"),
      "deck.toml:2:19: [regularisation] max_edge_length is not used with [mesh] file; remove one "
      "of them");
  EXPECT_EQ(error_of("[orientations]\ndistribution = \"input\"\n"),
            "deck.toml:2:16: [orientations] distribution = \"input\" needs a file in [polycrystal] "
            "or [mesh]");
  EXPECT_EQ(error_of("[mesh]\nfile = \"none.msh\"\n"),
            "deck.toml:2:8: [mesh] none.msh: no such file");
  EXPECT_EQ(error_of("[mesh]\nfile = \"slabs.msh\"\norder = 1\n"),
            "slabs.msh: elements of order 2, but the deck has order = 1 in [mesh]; give a mesh of "
            "that order, or change the key");
  EXPECT_EQ(error_of("[mesh]\nfile = \"a.tess\"\n"),
            "a.tess:1: '***tess' where $MeshFormat should be");
}

}  // namespace
}  // namespace polyslip::drivers
