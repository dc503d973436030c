// Wrong inputs and folders of `polyslip stats`.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/program.hpp"

namespace polyslip::tests {
namespace {

/// One grain: the unit cube in six tetrahedra.
const char* const cube = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
8
1 0 0 0
2 1 0 0
3 0 1 0
4 1 1 0
5 0 0 1
6 1 0 1
7 0 1 1
8 1 1 1
$EndNodes
$Elements
6
1 4 2 1 1 1 2 4 8
2 4 2 1 1 1 4 3 8
3 4 2 1 1 1 3 7 8
4 4 2 1 1 1 7 5 8
5 4 2 1 1 1 5 6 8
6 4 2 1 1 1 6 2 8
$EndElements
)";

TEST(Stats, OfWhatIsNoPolycrystal) {
  Sandbox sandbox;
  sandbox.write("notes.txt", "hello");
  sandbox.write("empty/notes.txt", "hello");
  expect_rejection(sandbox, {"stats", "nowhere.msh"}, "nowhere.msh: no such file or folder");
  expect_rejection(sandbox, {"stats", "notes.txt"},
                   "notes.txt: is neither a tessellation (.tess) nor a mesh (.msh), nor a folder "
                   "of polyslip run or mesh");
  expect_rejection(sandbox, {"stats", "empty"},
                   "empty: holds neither polycrystal.tess nor mesh-000.msh; give a folder of "
                   "polyslip run or mesh, or a .tess or .msh file");
}

TEST(Stats, WithoutInnerGrains) {
  Sandbox sandbox;
  sandbox.write("cube.msh", cube);
  expect_rejection(sandbox, {"stats", "cube.msh", "--inner", "--to", "out"},
                   "--inner: each of the 1 grains has a face on the domain boundary; leave it out");
}

TEST(Stats, NeverWriteOverEarlierOnes) {
  Sandbox sandbox;
  sandbox.write("cube.msh", cube);
  const Outcome first = run_polyslip({"stats", "cube.msh", "--to", "out"}, sandbox.path());
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("faces per grain"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(sandbox.path() / "out/elements.svg"));
  expect_rejection(sandbox, {"stats", "cube.msh", "--to", "out"},
                   "out: holds stats.json already; give another folder with --to, or replace it "
                   "with --overwrite");
  const Outcome again =
      run_polyslip({"stats", "cube.msh", "--to", "out", "--overwrite"}, sandbox.path());
  EXPECT_EQ(again.code, 0) << again.err;
  const std::string file = (std::filesystem::canonical(sandbox.path()) / "cube.msh").string();
  expect_rejection(sandbox, {"stats", "cube.msh", "--to", "cube.msh"},
                   "cube.msh: " + file + " is a file, not a folder; give another folder with --to");
}

/// What is read of a folder, and what it says when something is missing.
TEST(Stats, OfAFolderOfAMesh) {
  Sandbox sandbox;
  sandbox.write("deck.toml",
                "[polycrystal]\ngrains = 2\n[mesh]\nelement_size = 1.5\nelement_size_outer = 1.2\n"
                "meshers = [\"gmsh-hxt\"]\n");
  const Outcome made = run_polyslip({"mesh", "deck.toml", "--out", "out"}, sandbox.path());
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome all = run_polyslip({"stats", "out"}, sandbox.path());
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_NE(all.out.find("out: 2 grains (0 inner)"), std::string::npos) << all.out;
  EXPECT_NE(all.out.find("c_l = 1.5 (some grains their own), from the deck"), std::string::npos)
      << all.out;
  EXPECT_NE(all.out.find("radius ratio"), std::string::npos) << all.out;
  EXPECT_TRUE(std::filesystem::exists(sandbox.path() / "out/regularisation.json"));
  std::filesystem::remove(sandbox.path() / "out/mesh-000.msh");
  const Outcome rest = run_polyslip({"stats", "out"}, sandbox.path());
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(rest.out.find("radius ratio"), std::string::npos) << rest.out;
  EXPECT_NE(rest.out.find("sphericity"), std::string::npos) << rest.out;
}

TEST(Stats, OfAnElementSizeThatIsNone) {
  Sandbox sandbox;
  sandbox.write("cube.msh", cube);
  const Outcome outcome =
      run_polyslip({"stats", "cube.msh", "--element-size", "0"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--element-size"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace polyslip::tests
