// The decks in inputs/ that show a morphology: each gives a mesh.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "support/program.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Morphologies, EveryDeckGivesAMeshAndAPicture) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(POLYSLIP_SOURCE_DIR) / "inputs")) {
    if (text_of(entry.path()).find("docs/polycrystals.md") == std::string::npos) continue;
    SCOPED_TRACE(entry.path().filename().string());
    Sandbox sandbox;
    std::string deck = text_of(entry.path());
    const std::regex size("(element_size(_outer)? +=) +[0-9.]+");
    ASSERT_TRUE(std::regex_search(deck, size));
    deck = std::regex_replace(deck, size, "$1 1.2");  // quicker
    sandbox.write("deck.toml", deck);
    if (deck.find("seeds.txt") != std::string::npos)
      sandbox.write("seeds.txt", text_of(entry.path().parent_path() / "seeds.txt"));
    std::vector<std::string> call{"mesh", "deck.toml", "--out", "mesh", "--picture", "mesh.png"};
    if (deck.find("--cut") != std::string::npos) call.push_back("--cut");
    const Outcome outcome = run_polyslip(call, sandbox.path());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(fs::file_size(sandbox.path() / "mesh" / "mesh-000.msh"), 10'000u);
    EXPECT_GT(fs::file_size(sandbox.path() / "mesh.png"), 1'000u);
    ++count;
  }
  EXPECT_GE(count, 13);
}

TEST(Morphologies, APictureNeedsAFolder) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "");
  expect_rejection(sandbox, {"mesh", "deck.toml", "--out", "out", "--picture", "no/mesh.png"},
                   "--picture no/mesh.png: no such folder as no");
}

}  // namespace
}  // namespace polyslip::tests
