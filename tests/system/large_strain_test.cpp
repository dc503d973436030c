// A polycrystal to large strain with no hand on it: the deck of inputs/plane-strain-large.toml with
// thirty grains, to a strain of 1.4.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mesh/mesh.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

void put(std::string& deck, const std::string& old, const std::string& fresh) {
  const auto at = deck.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  deck.replace(at, old.size(), fresh);
}

/// Limits of the project: grain volumes change by no more than 0.3 % in a remeshing, at most 1 % of
/// all faces are copied; accumulated over all remeshings no volume is off by more than 0.7 %.
TEST(LargeStrain, SlowRemeshesItselfToAStrainOf1p4) {
  std::string deck = slurp(std::string(POLYSLIP_SOURCE_DIR) + "/inputs/plane-strain-large.toml");
  put(deck, "grains = 100", "grains = 30");
  put(deck, "final_strain = 2.5", "final_strain = 1.4");
  put(deck, "at_strains = [0.5, 1.0, 1.5, 2.0]", "at_strains = [0.5, 1.0]");
  Sandbox sandbox;
  run_deck(sandbox, 1, deck, "run");
  const auto run = sandbox.path() / "run";
  const auto first = state_of(run, 0), last = last_state(run);
  EXPECT_NEAR(last.strain, 1.4, 1e-9);
  ASSERT_NO_THROW(mesh::check(last.mesh));
  const auto from = mesh::grain_volumes(first.mesh), to = mesh::grain_volumes(last.mesh);
  ASSERT_EQ(from.size(), 30u);
  for (std::size_t g = 0; g < from.size(); ++g) EXPECT_NEAR(to[g] / from[g], 1, 7e-3) << g;
  const auto summary = nlohmann::json::parse(slurp(run / "summary.json"));
  EXPECT_TRUE(summary.at("completed").get<bool>());
  const auto& remeshings = summary.at("remeshings");
  ASSERT_FALSE(remeshings.empty());
  std::size_t copied = 0;
  for (const auto& r : remeshings) {
    EXPECT_LT(r.at("max_grain_volume_change").get<double>(), 3e-3);
    copied += r.at("copied_faces").get<std::size_t>();
  }
  EXPECT_LE(copied, remeshings.size() * last.mesh.topology.faces.size() / 100);
}

}  // namespace
}  // namespace polyslip::tests
