// kill -9 at any moment, then `polyslip run --restart DIR`: the run ends as one that nobody
// disturbed, bit for bit on the same number of ranks.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "results/names.hpp"
#include "results/state_file.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

/// When to kill, by what is in the run folder, the program having been started at `since`.
struct Moment {
  const char* name;
  std::function<bool(const fs::path& run, fs::file_time_type since)> has_come;
  const char* restart_says;    ///< that follows a kill at this moment
  bool may_be_missed = false;  ///< over in milliseconds
};

bool has_rows(const fs::path& run, long count) { return line_count(run / "macro.csv") > count; }

bool has_checkpoint(const fs::path& run, int number) {
  return fs::exists(run / "checkpoints" / results::checkpoint_name(number));
}

/// A state is being written (parts that an earlier kill left do not count).
bool has_part(const fs::path& folder, fs::file_time_type since) {
  std::error_code error, gone;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().string().ends_with(".h5.part") && it->last_write_time(gone) > since && !gone)
      return true;
  return false;
}

/// In the order in which they come; each is later than all that a run killed before has reached.
std::vector<Moment> moments() {
  const char *over = "no checkpoint yet; starting over", *on = "going on from strain";
  return {
      {"while growing and meshing", [](auto& run, auto) { return fs::exists(run / "log.txt"); },
       over, true},
      {"after two steps", [](auto& run, auto) { return has_rows(run, 2); }, over},
      {"after the first checkpoint", [](auto& run, auto) { return has_checkpoint(run, 1); }, on},
      {"between two checkpoints", [](auto& run, auto) { return has_rows(run, 10); }, on},
      {"while a checkpoint is written",
       [](auto& run, auto since) { return has_part(run / "checkpoints", since); }, on, true},
      {"while remeshing", [](auto& run, auto) { return has_checkpoint(run, 3); }, on},
      {"just after the remeshing",
       [](auto& run, auto) { return fs::exists(run / results::mesh_name(1)); }, on},
      {"after the checkpoint on the new mesh",
       [](auto& run, auto) { return has_checkpoint(run, 4); }, on},
      {"while reloading", [](auto& run, auto) { return has_rows(run, 16); }, on},
      {"late", [](auto& run, auto) { return has_rows(run, 20); }, on},
      {"while a state is written",
       [](auto& run, auto since) { return has_part(run / "results", since); }, on, true},
      {"while the summary or the picture is made",
       [](auto& run, auto) { return fs::exists(run / "summary.json"); }, on, true},
  };
}

/// What a user's kill hits: the program on all ranks and their launcher. All else ends by itself.
void kill_job(Program& program) {
  program.kill({"polyslip", "mpirun", "orterun"});
  const bool gone = eventually(30, [&] { return program.processes().empty(); });
  for (const auto& [pid, name] : program.processes())
    EXPECT_TRUE(gone) << "process " << pid << ", " << name << ", survives its run";
}

/// Files that have their name are whole.
void expect_no_half_file(const fs::path& run) {
  for (const auto* sub : {"checkpoints", "results"}) {
    std::error_code error;
    for (fs::directory_iterator it(run / sub, error), end; !error && it != end;
         it.increment(error)) {
      if (it->path().extension() != ".h5") continue;
      EXPECT_NO_THROW(results::verify_state(it->path().string())) << it->path();
    }
  }
}

/// The names of the files in a folder.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& [name, content] : tree(folder)) names.push_back(name);
  return names;
}

/// Curve, states, meshes, time series and the list of files are those of the other run.
void expect_same_run(const fs::path& a, const fs::path& b) {
  EXPECT_GT(line_count(a / "macro.csv"), 20);
  for (const auto* file : {"macro.csv", "results.xdmf", "results/index.json", "mesh-000.msh",
                           "mesh-001.msh", "polycrystal.tess", "deck.toml", "deck.resolved.toml"})
    EXPECT_EQ(slurp(a / file), slurp(b / file)) << file;
  EXPECT_EQ(names_in(a), names_in(b));
  ASSERT_EQ(state_count(a), 5u);
  ASSERT_EQ(state_count(b), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    expect_identical(state_of(a, i), state_of(b, i));
  }
}

/// One run, killed at every moment in turn, against one that nobody disturbs.
void kill_at_every_moment(int ranks) {
  Sandbox sandbox;
  run_deck(sandbox, ranks, small_deck(), "undisturbed");
  ASSERT_FALSE(::testing::Test::HasFailure());
  sandbox.write("killed.toml", small_deck());
  const fs::path run = sandbox.path() / "killed";
  std::vector<std::string> arguments{"run", "killed.toml", "--out", "killed"};
  std::string says;
  for (const Moment& moment : moments()) {
    SCOPED_TRACE(moment.name);
    const auto since = fs::file_time_type::clock::now();
    Program program(on_ranks(ranks, arguments), sandbox.path());
    ASSERT_TRUE(eventually(120, [&] { return moment.has_come(run, since) || program.ended(); }));
    kill_job(program);
    const Outcome outcome = program.wait();
    const std::string said = outcome.out + outcome.err, log = slurp(run / "log.txt");
    const std::size_t from = log.rfind(" polyslip ");  // the last session's first line
    EXPECT_NE(log.find(says, says.empty() ? 0 : from), std::string::npos) << says << "\n" << log;
    EXPECT_TRUE(outcome.code == 128 + SIGKILL || (moment.may_be_missed && outcome.code == 0))
        << outcome.code << "\n"
        << said;
    expect_no_half_file(run);
    says = moment.restart_says;
    arguments = {"run", "--restart", "killed"};
  }
  const Outcome outcome = run_program(on_ranks(ranks, arguments), sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find(says), std::string::npos) << outcome.out;
  expect_same_run(sandbox.path() / "undisturbed", run);
}

TEST(Restart, AfterAKillAtAnyMomentEndsTheSame) { kill_at_every_moment(0); }
TEST(Restart, AfterAKillAtAnyMomentEndsTheSameOnTwoRanks) { kill_at_every_moment(2); }

/// A run of this deck that is killed at its first checkpoint ends as one that nobody disturbs. The
/// sandbox then holds both.
void kill_once(const Sandbox& sandbox, const std::string& deck) {
  run_deck(sandbox, 0, deck, "undisturbed");
  ASSERT_FALSE(::testing::Test::HasFailure());
  const fs::path run = sandbox.path() / "killed";
  sandbox.write("killed.toml", deck);
  Program program(on_ranks(0, {"run", "killed.toml", "--out", "killed"}), sandbox.path());
  ASSERT_TRUE(eventually(120, [&] { return has_checkpoint(run, 1) || program.ended(); }));
  kill_job(program);
  program.wait();
  const Outcome outcome = run_polyslip({"run", "--restart", "killed"}, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("going on from strain"), std::string::npos) << outcome.out;
  expect_same_run(sandbox.path() / "undisturbed", run);
}

/// Fifteen points fill four blocks but for one lane; their states cross the remeshing too.
TEST(Restart, KeepsTheStatesOfOtherElementsAndPoints) {
  Sandbox sandbox;
  kill_once(sandbox, small_deck("", "element = \"displacement\"\nquadrature_points = 15\n"));
  ASSERT_FALSE(::testing::Test::HasFailure());
  EXPECT_EQ(last_state(sandbox.path() / "undisturbed").quadrature_points, 15);
  const Outcome table = run_polyslip(
      {"convert", "killed", "--at-strain", "1", "--value", "centroid", "--to", "table.csv"},
      sandbox.path());
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_GT(line_count(sandbox.path() / "table.csv"), 100);
}

TEST(Restart, KeepsTwelveUnequalStrengths) {
  Sandbox sandbox;
  kill_once(sandbox, small_deck() + "[material]\nlatent_ratio = 1.4\n");
  ASSERT_FALSE(::testing::Test::HasFailure());
  const mesh::Snapshot last = last_state(sandbox.path() / "killed");
  const auto* g = last.find("g", mesh::Location::quadrature_point);
  ASSERT_NE(g, nullptr);
  ASSERT_EQ(g->components, 12);
  EXPECT_GT(*std::max_element(g->values.begin(), g->values.begin() + 12),
            *std::min_element(g->values.begin(), g->values.begin() + 12) + 1e-3);
}

/// Stresses that cross a remeshing start its first step, before and after the kill.
TEST(Restart, WithCarriedStressesEndsTheSame) {
  Sandbox sandbox;
  std::string deck = small_deck();
  const auto at = deck.find("[remeshing]\n");
  ASSERT_NE(at, std::string::npos);
  deck.insert(at + 12, "stress = \"carried\"\n");
  kill_once(sandbox, deck);
  ASSERT_FALSE(::testing::Test::HasFailure());
  for (const auto& row : read_macro(sandbox.path() / "killed"))
    if (row.remeshed) {
      EXPECT_GT(row.von_mises(), 0.8 * stress_at(read_macro(sandbox.path() / "killed"), 0.03));
    }
}

/// What a kill can leave: rows, states and meshes beyond the checkpoint, torn lines, parts of
/// files.
TEST(Restart, TrimsWhatIsLaterThanItsCheckpoint) {
  Sandbox sandbox;
  run_deck(sandbox, 0, small_deck(), "undisturbed");
  ASSERT_FALSE(::testing::Test::HasFailure());
  const fs::path undisturbed = sandbox.path() / "undisturbed", run = sandbox.path() / "killed";
  fs::copy(undisturbed, run, fs::copy_options::recursive);
  std::vector<std::string> checkpoints = names_in(run / "checkpoints");
  ASSERT_EQ(checkpoints.size(), 2u);
  fs::remove(run / "checkpoints" / checkpoints[1]);
  const std::string half = slurp(run / "results/state-0004.h5").substr(0, 5000);
  sandbox.write("killed/checkpoints/" + checkpoints[1] + ".part", half);
  sandbox.write("killed/results/state-0005.h5.part", half);
  sandbox.write("killed/results.xdmf.part", "<Xdmf");
  sandbox.write("killed/macro.csv", slurp(run / "macro.csv") + "0.07,0.0");
  const Outcome outcome = run_polyslip({"run", "--restart", "killed"}, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("going on from strain 0.05"), std::string::npos) << outcome.out;
  expect_same_run(undisturbed, run);
}

/// It has nothing left to do, and does not harm what is there.
TEST(Restart, OfARunThatHasEndedLeavesItAsItIs) {
  Sandbox sandbox;
  run_deck(sandbox, 0, small_deck(), "run");
  ASSERT_FALSE(::testing::Test::HasFailure());
  fs::copy(sandbox.path() / "run", sandbox.path() / "before", fs::copy_options::recursive);
  const Outcome outcome = run_polyslip({"run", "--restart", "run"}, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_same_run(sandbox.path() / "before", sandbox.path() / "run");
}

}  // namespace
}  // namespace polyslip::tests
