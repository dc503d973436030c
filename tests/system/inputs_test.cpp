// Runs that begin with a polycrystal or a mesh made elsewhere, packed or not, remeshed on the way.

#include <gtest/gtest.h>

#include <cstdlib>

#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

const std::string loading =
    "[loading]\nfinal_strain = 0.04\nmax_strain_increment = 0.01\n"
    "[remeshing]\nat_strains = [0.02]\n";

void pack(const fs::path& file) {
  ASSERT_EQ(std::system(("gzip -f '" + file.string() + "'").c_str()), 0);
}

/// Ran to the end, was remeshed, kept the file's orientations and hardened.
void expect_run(const fs::path& run) {
  const auto rows = read_macro(run);
  ASSERT_GT(rows.size(), 4u);
  EXPECT_NEAR(rows.back().strain, 0.04, 1e-9);
  int remeshed = 0;
  for (const auto& row : rows) remeshed += row.remeshed;
  EXPECT_EQ(remeshed, 1);
  EXPECT_GT(rows.back().von_mises(), 15);
  EXPECT_LT(rows.back().von_mises(), 40);
  EXPECT_NE(slurp(run / "log.txt").find("orientations: those of the file"), std::string::npos);
}

/// 20 grains of Neper's, not regularised, as they came.
TEST(Inputs, ATessellationOfNepersRunsAndIsRemeshed) {
  Sandbox sandbox;
  sandbox.write("data/n20.tess", slurp(POLYSLIP_SOURCE_DIR "/tests/data/n20-id1-raw.tess"));
  pack(sandbox.path() / "data" / "n20.tess");
  run_deck(sandbox, 2,
           "[polycrystal]\nfile = \"data/n20.tess.gz\"\n[mesh]\nelement_size = 1.0\n" + loading,
           "run");
  expect_run(sandbox.path() / "run");
}

TEST(Inputs, AMeshFileRunsAndIsRemeshed) {
  Sandbox sandbox;
  sandbox.write("n20.tess", slurp(POLYSLIP_SOURCE_DIR "/tests/data/n20-id1-raw.tess"));
  sandbox.write("mesh.toml", "[polycrystal]\nfile = \"n20.tess\"\n[mesh]\nelement_size = 1.0\n");
  const Outcome made = run_polyslip({"mesh", "mesh.toml", "--out", "mesh"}, sandbox.path());
  ASSERT_EQ(made.code, 0) << made.err;
  pack(sandbox.path() / "mesh" / "mesh-000.msh");
  run_deck(sandbox, 1, "[mesh]\nfile = \"mesh/mesh-000.msh.gz\"\nelement_size = 1.0\n" + loading,
           "run");
  expect_run(sandbox.path() / "run");
}

/// 20 grains in 795 elements of Neper's, with its orientations, as they came.
TEST(Inputs, AMeshOfNepersRunsAndIsRemeshed) {
  Sandbox sandbox;
  fs::copy_file(POLYSLIP_SOURCE_DIR "/tests/data/fepx/n20_coarse.msh.gz",
                sandbox.path() / "n20.msh.gz");
  run_deck(sandbox, 1, "[mesh]\nfile = \"n20.msh.gz\"\nelement_size = 1.0\n" + loading, "run");
  expect_run(sandbox.path() / "run");
}

}  // namespace
}  // namespace polyslip::tests
