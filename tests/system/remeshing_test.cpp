// What makes a run remesh, and what it does when that fails.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numeric>

#include "results/names.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int exit_stopped = 3;

/// Eight grains to 0.06; further lines go into [loading], [remeshing], [solver].
std::string deck_of(const std::string& polycrystal, const std::string& loading,
                    const std::string& remeshing, const std::string& solver = "") {
  return polycrystal + "[loading]\nmax_strain_increment = 0.01\n" + loading + "[remeshing]\n" +
         remeshing + "[solver]\n" + solver + "[output]\ncheckpoint_every_strain = 0.02\n";
}

const std::string grown =
    "[polycrystal]\ngrains = 8\nseed = 1\n[mesh]\nelement_size = 0.8\nmeshers = [\"gmsh-hxt\"]\n";
/// Meshed before, so that faults of meshers strike remeshings only.
const std::string meshed = "[mesh]\nelement_size = 0.8\nfile = \"meshed/mesh-000.msh\"\n";
const std::string to_the_end = "final_strain = 0.06\n";
const std::string wears_soon = "radius_ratio_share = 0.995\nmin_interval = 0.025\n";
/// A rate ten million times slower, at which the flow stress is a hundred and twenty times smaller:
/// steps this large take eight iterations from the stress there was and five from zero stress; so
/// do steps half as large.
const std::string slackens =
    "initial_strain_increment = 3e-3\nmin_strain_increment = 1.6e-3\n"
    "[[loading.stage]]\nstrain = 0.02\n[[loading.stage]]\nstrain = 0.026\nstrain_rate = 1e-7\n";
const std::string six_iterations =
    "max_newton_iterations = 6\n[material]\nrate_sensitivity = 0.3\n";

/// The variable that makes meshers fail, while it lives.
class MesherFaults {
 public:
  explicit MesherFaults(const std::string& faults) {
    ::setenv("POLYSLIP_MESHER_FAULT", faults.c_str(), 1);
  }
  ~MesherFaults() { ::unsetenv("POLYSLIP_MESHER_FAULT"); }
  MesherFaults(const MesherFaults&) = delete;
  MesherFaults& operator=(const MesherFaults&) = delete;
};

void make_first_mesh(const Sandbox& sandbox) {
  sandbox.write("meshed.toml", grown);
  const Outcome made = run_polyslip({"mesh", "meshed.toml", "--out", "meshed"}, sandbox.path());
  ASSERT_EQ(made.code, 0) << made.err;
}

json summary_of(const Sandbox& sandbox) {
  return json::parse(slurp(sandbox.path() / "run/summary.json"));
}

TEST(Remeshing, OfWornElementsComesByItself) {
  const Sandbox sandbox;
  run_deck(sandbox, 2, deck_of(grown, "final_strain = 0.07\n", wears_soon), "run");
  ASSERT_FALSE(HasFailure());
  const json s = summary_of(sandbox);
  ASSERT_GE(s.at("remeshings").size(), 2u);
  double last = -1;
  for (const json& r : s["remeshings"]) {
    EXPECT_EQ(r.at("trigger"), "worn elements");
    EXPECT_NE(r.at("reason").get<std::string>().find("radius_ratio_share = 0.995"),
              std::string::npos);
    EXPECT_EQ(r.at("attempts"), 1);
    EXPECT_GE(r.at("strain").get<double>(), last);
    last = r["strain"].get<double>() + 0.025;  // min_interval
    EXPECT_NE(slurp(sandbox.path() / "run/log.txt").find(r["reason"].get<std::string>()),
              std::string::npos);
  }
  EXPECT_LE(last, 0.07);  // not so near the end
  // Both sides of each are stored, besides start and end.
  EXPECT_EQ(state_count(sandbox.path() / "run"), 2 + 2 * s["remeshings"].size());
  EXPECT_TRUE(s.at("failed_remeshings").empty());
}

double sum(const mesh::Snapshot& s, const char* field) {
  const mesh::Field* found = s.find(field, mesh::Location::element);
  if (!found) return NAN;
  return std::accumulate(found->values.begin(), found->values.end(), 0.0);
}

/// Stresses start from zero, but what pressure compressed is no smaller without it: two remeshings
/// under a compression of 0.01 to 0.02 % leave the volume at zero pressure as it was.
TEST(Remeshing, LosesNoVolumeToPressure) {
  for (const char* element : {"mixed", "displacement"}) {
    SCOPED_TRACE(element);
    const Sandbox sandbox;
    run_deck(sandbox, 0,
             deck_of(grown, "final_strain = 0.03\n", "at_strains = [0.01, 0.02]\n",
                     fmt::format("element = \"{}\"\n", element)),
             "run");
    ASSERT_FALSE(HasFailure());
    const auto run = sandbox.path() / "run";
    const mesh::Snapshot last = last_state(run);
    EXPECT_EQ(last.mesh_number, 2);
    const double start = sum(state_of(run, 0), "volume");
    EXPECT_NEAR(sum(last, "reference_volume") / start, 1, 1e-6);
    EXPECT_LT(sum(last, "volume") / start, 1 - 1e-4);
    EXPECT_GT(sum(last, "volume") / start, 1 - 2e-4);
    for (const json& r : summary_of(sandbox).at("remeshings")) {
      const double before = r.at("before").at("volume_at_zero_pressure");
      EXPECT_NEAR(r.at("after").at("volume_at_zero_pressure").get<double>() / before, 1, 1e-8);
      EXPECT_LT(r.at("after").at("volume").get<double>() / before, 1 - 1e-4);
    }
  }
}

TEST(Remeshing, IsLeftAloneIfTheDeckSaysSo) {
  const Sandbox sandbox;
  run_deck(sandbox, 0, deck_of(grown, to_the_end, wears_soon + "automatic = false\n"), "run");
  ASSERT_FALSE(HasFailure());
  EXPECT_TRUE(summary_of(sandbox).at("remeshings").empty());
}

/// Killed at the checkpoint that comes before the first remeshing.
TEST(Remeshing, OfWornElementsComesAgainAfterAKill) {
  const Sandbox sandbox;
  const std::string deck = deck_of(grown, to_the_end, wears_soon);
  run_deck(sandbox, 0, deck, "undisturbed");
  sandbox.write("run.toml", deck);
  const fs::path run = sandbox.path() / "run";
  Program program(on_ranks(0, {"run", "run.toml", "--out", "run"}), sandbox.path());
  ASSERT_TRUE(eventually(120, [&] {
    return fs::exists(run / "checkpoints" / results::checkpoint_name(1)) || program.ended();
  }));
  program.kill({});
  EXPECT_EQ(program.wait().code, 128 + SIGKILL);
  const Outcome outcome = run_polyslip({"run", "--restart", "run"}, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("a remeshing is due: worst radius ratio"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(slurp(run / "macro.csv"), slurp(sandbox.path() / "undisturbed/macro.csv"));
  expect_identical(last_state(sandbox.path() / "undisturbed"), last_state(run));
}

TEST(Remeshing, ComesWhenNoStepConverges) {
  const Sandbox sandbox;
  run_deck(sandbox, 0, deck_of(grown, slackens, "", six_iterations), "run");
  ASSERT_FALSE(HasFailure());
  const json s = summary_of(sandbox);
  ASSERT_EQ(s.at("remeshings").size(), 1u);
  EXPECT_EQ(s["remeshings"][0].at("trigger"), "failed step");
  EXPECT_EQ(s.at("final_strain"), json(0.026));
}

TEST(Remeshing, GoesOnToTheNextMesherWhenOneFails) {
  const Sandbox sandbox;
  make_first_mesh(sandbox);
  const MesherFaults faults("gmsh-hxt:1:throw");
  run_deck(sandbox, 0,
           deck_of(meshed + "meshers = [\"gmsh-hxt\"]\n", to_the_end, "at_strains = [0.03]\n"),
           "run");
  ASSERT_FALSE(HasFailure());
  const json s = summary_of(sandbox);
  ASSERT_EQ(s.at("remeshings").size(), 1u);
  EXPECT_EQ(s["remeshings"][0].at("attempts"), 2);
}

TEST(Remeshing, ThatFailsLeavesTheOldMesh) {
  const Sandbox sandbox;
  make_first_mesh(sandbox);
  const MesherFaults faults("gmsh-hxt:1:throw,gmsh-delaunay:1:throw,netgen:1:throw");
  const std::string deck = deck_of(meshed, to_the_end, "at_strains = [0.03]\n");
  sandbox.write("run.toml", deck);
  const Outcome outcome = run_polyslip({"run", "run.toml", "--out", "run"}, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: strain 0.03: going on with the old mesh"), std::string::npos)
      << outcome.err;
  const json s = summary_of(sandbox);
  EXPECT_TRUE(s.at("remeshings").empty());
  ASSERT_EQ(s.at("failed_remeshings").size(), 1u);
  EXPECT_EQ(s["failed_remeshings"][0].at("strain"), json(0.03));
  EXPECT_NE(s["failed_remeshings"][0].at("reason").get<std::string>().find("grain 2"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(sandbox.path() / "run/mesh-001.msh"));
  for (const MacroRow& row : read_macro(sandbox.path() / "run")) EXPECT_FALSE(row.remeshed);
}

/// Whatever mesh is tried; and a restart does not go on without the remeshing.
TEST(Remeshing, ThatTurnsAGrainTooFarStopsTheRunAndNamesIt) {
  const Sandbox sandbox;
  sandbox.write(
      "run.toml",
      deck_of(grown, "final_strain = 0.03\n",
              "at_strains = [0.02]\ntransport = \"element\"\nmax_grain_rotation = 1e-4\n"));
  for (const auto& call : {std::vector<std::string>{"run", "run.toml", "--out", "run"},
                           std::vector<std::string>{"run", "--restart", "run"}}) {
    const Outcome outcome = run_polyslip(call, sandbox.path());
    EXPECT_EQ(outcome.code, exit_stopped) << outcome.err;
    const std::string reason = "error: remeshing at strain 0.02: the mean orientation of grain ";
    const auto at = outcome.err.find(reason);
    ASSERT_NE(at, std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("above [remeshing] max_grain_rotation = 0.0001 degrees", at),
              std::string::npos);
    EXPECT_EQ(summary_of(sandbox).at("final_strain"), json(0.02));
    EXPECT_TRUE(summary_of(sandbox).at("remeshings").empty());
  }
}

/// No step converges and no mesh can be made, but on the old one smaller steps do.
TEST(Remeshing, ThatFailsWhereNoStepConvergesGoesOnWithTheSmallest) {
  const Sandbox sandbox;
  make_first_mesh(sandbox);
  const MesherFaults faults("gmsh-hxt:1:throw,gmsh-delaunay:1:throw,netgen:1:throw");
  run_deck(sandbox, 0, deck_of(meshed, slackens, "", six_iterations), "run");
  ASSERT_FALSE(HasFailure());
  EXPECT_GE(summary_of(sandbox).at("failed_remeshings").size(), 1u);
  EXPECT_EQ(summary_of(sandbox).at("final_strain"), json(0.026));
}

/// The same where none so small is allowed: the run stops and says why. A restart tries again.
TEST(Remeshing, ThatFailsWhereNoStepConvergesStopsTheRun) {
  const Sandbox sandbox;
  make_first_mesh(sandbox);
  std::string loading = slackens;
  loading.replace(loading.find("1.6e-3"), 6, "2.99e-3");
  sandbox.write("run.toml", deck_of(meshed, loading, "", six_iterations));
  const MesherFaults faults("gmsh-hxt:1:throw,gmsh-delaunay:1:throw,netgen:1:throw");
  std::size_t failed = 0;
  for (const auto& call : {std::vector<std::string>{"run", "run.toml", "--out", "run"},
                           std::vector<std::string>{"run", "--restart", "run"}}) {
    const Outcome outcome = run_polyslip(call, sandbox.path());
    EXPECT_EQ(outcome.code, exit_stopped) << outcome.err;
    EXPECT_NE(outcome.err.find("no step converges on the old mesh, and no new one could be made; "
                               "last failure: grain 2 could not be meshed"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(summary_of(sandbox).at("completed"), json(false));
    EXPECT_EQ(summary_of(sandbox).at("failed_remeshings").size(), ++failed);
  }
}

}  // namespace
}  // namespace polyslip::tests
