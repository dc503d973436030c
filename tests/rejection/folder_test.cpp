// Wrong folders, files of a run, and command lines: one clear line, exit code 2, the disk as it
// was.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/program.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

const char* const deck = R"([polycrystal]
grains = 2
[mesh]
element_size = 1.5
meshers = ["gmsh-hxt"]
[loading]
final_strain = 0.002
max_strain_increment = 0.001
[output]
checkpoint_every_strain = 0.001
report = false
)";

/// A finished run in "run", made once; each test has a copy to damage.
class Folder : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<Sandbox>();
    made_->write("deck.toml", deck);
    const Outcome outcome = run_polyslip({"run", "deck.toml", "--out", "run"}, made_->path());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { made_.reset(); }
  void SetUp() override {
    sandbox.write("deck.toml", deck);
    fs::copy(made_->path() / "run", sandbox.path() / "run", fs::copy_options::recursive);
    ASSERT_EQ(slurp(newest()).size() > 10000, true) << newest();
    ASSERT_FALSE(fs::exists(sandbox.path() / "run/checkpoints/checkpoint-0003.h5"));
  }
  fs::path newest() const { return sandbox.path() / "run/checkpoints/checkpoint-0002.h5"; }
  void damage(const std::string& content) const {
    sandbox.write("run/checkpoints/checkpoint-0002.h5", content);
  }
  void rejected(const std::vector<std::string>& arguments, const std::string& line) const {
    expect_rejection(sandbox, arguments, line);
  }
  void restart_rejected(const std::string& line) const {
    rejected({"run", "--restart", "run"}, line);
  }
  void convert_rejected(const std::string& folder, const std::string& to,
                        const std::string& line) const {
    rejected({"convert", folder, "--at-strain", "0", "--to", to}, line);
  }

  Sandbox sandbox;
  static std::unique_ptr<Sandbox> made_;
};

std::unique_ptr<Sandbox> Folder::made_;

TEST_F(Folder, WithResultsOfAnEarlierRun) {
  const std::string line =
      "run: holds the results of an earlier run (checkpoints/checkpoint-0001.h5 and 13 more "
      "files); give another folder with --out, go on with it by --restart, or replace it with "
      "--overwrite";
  rejected({"run", "deck.toml", "--out", "run"}, line);
  rejected({"mesh", "deck.toml", "--out", "run"}, line);
}

TEST_F(Folder, WithAnotherDeckOfTheUser) {
  sandbox.write("mine/deck.toml", "[mesh]\norder = 2\n");
  for (const auto* verb : {"run", "mesh"})
    rejected({verb, "deck.toml", "--out", "mine"},
             "mine/deck.toml: is another deck; give another folder with --out, or replace it with "
             "--overwrite");
}

TEST_F(Folder, ThatIsAFile) {
  const std::string file = (fs::canonical(sandbox.path()) / "deck.toml").string();
  const std::string why = ": " + file + " is a file, not a folder; give another folder with --out";
  for (const auto* verb : {"run", "mesh"})
    for (const std::string out : {"deck.toml", "deck.toml/below", "deck.toml/far/below"})
      rejected({verb, "deck.toml", "--out", out}, out + why);
}

TEST_F(Folder, WithAFileWhereAFolderIsNeeded) {
  sandbox.write("out/results", "");
  rejected({"run", "deck.toml", "--out", "out"},
           "out/results: is a file where a folder is needed; move it away");
}

/// Nobody, root neither, can make a folder there.
TEST_F(Folder, ThatCannotBeWrittenTo) {
  const Outcome outcome =
      run_polyslip({"run", "deck.toml", "--out", "/proc/polyslip"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.rfind("/proc: cannot write in this folder: ", 0), 0u) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
}

TEST_F(Folder, ToRestartIsMissingOrNoRun) {
  fs::create_directory(sandbox.path() / "empty");
  for (const std::string folder : {"nowhere", "empty", "deck.toml"})
    rejected({"run", "--restart", folder},
             folder +
                 "/deck.resolved.toml: no such file, so there is no run to go on with; start "
                 "one with polyslip run DECK.toml --out " +
                 folder);
}

TEST_F(Folder, WithATruncatedCheckpoint) {
  const std::string whole = slurp(newest());
  damage(whole.substr(0, 5000));
  restart_rejected(
      "run/checkpoints/checkpoint-0002.h5: is damaged (4488 bytes after the header instead of " +
      std::to_string(whole.size() - 512) +
      "); delete this file to restart from run/checkpoints/checkpoint-0001.h5, which is intact");
  damage(whole.substr(0, whole.size() - 1));
  restart_rejected(
      "run/checkpoints/checkpoint-0002.h5: is damaged (" + std::to_string(whole.size() - 513) +
      " bytes after the header instead of " + std::to_string(whole.size() - 512) +
      "); delete this file to restart from run/checkpoints/checkpoint-0001.h5, which is intact");
  damage("");
  restart_rejected(
      "run/checkpoints/checkpoint-0002.h5: is damaged (only 0 bytes long); delete this file to "
      "restart from run/checkpoints/checkpoint-0001.h5, which is intact");
}

TEST_F(Folder, WithAFlippedBitInACheckpoint) {
  const std::string whole = slurp(newest());
  for (const std::size_t at : {std::size_t{600}, whole.size() / 2, whole.size() - 1}) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    damage(flipped);
    restart_rejected(
        "run/checkpoints/checkpoint-0002.h5: is damaged (checksum does not match); delete this "
        "file to restart from run/checkpoints/checkpoint-0001.h5, which is intact");
  }
}

/// The way out that the line names works.
TEST_F(Folder, GoesOnFromTheCheckpointBefore) {
  const std::string curve = slurp(sandbox.path() / "run/macro.csv");
  damage("");
  fs::remove(newest());
  const Outcome outcome = run_polyslip({"run", "--restart", "run"}, sandbox.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("going on from strain 0.001"), std::string::npos) << outcome.out;
  EXPECT_EQ(slurp(sandbox.path() / "run/macro.csv"), curve);
}

TEST_F(Folder, WithACheckpointOfAnotherDeck) {
  std::string other = deck;
  other.replace(other.find("0.002"), 5, "0.003");
  sandbox.write("other.toml", other);
  const Outcome made = run_polyslip({"run", "other.toml", "--out", "other"}, sandbox.path());
  ASSERT_EQ(made.code, 0) << made.err;
  fs::copy(sandbox.path() / "other/checkpoints/checkpoint-0003.h5",
           sandbox.path() / "run/checkpoints/checkpoint-0003.h5");
  const auto before = tree(sandbox.path());
  const Outcome outcome = run_polyslip({"run", "--restart", "run"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.rfind("run/checkpoints/checkpoint-0003.h5: checkpoint of another deck", 0),
            0u)
      << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  EXPECT_EQ(tree(sandbox.path()), before);
}

TEST_F(Folder, WhoseDeckWasEdited) {
  std::string other = deck;
  other.replace(other.find("0.002"), 5, "0.003");
  sandbox.write("run/deck.toml", other);
  restart_rejected(
      "run/deck.toml: not the deck that run/checkpoints/checkpoint-0002.h5 was computed with; put "
      "the run's own deck back, or start a new run");
  fs::remove_all(sandbox.path() / "run/checkpoints");
  restart_rejected(
      "run/deck.toml: not the deck that this run began with; put that back, or start a new run");
}

TEST_F(Folder, WhoseResolvedDeckWasEdited) {
  const std::string text = slurp(sandbox.path() / "run/deck.resolved.toml");
  std::string other = text;
  other.replace(other.find("final_strain = 0.002"), 20, "final_strain = 0.003");
  sandbox.write("run/deck.resolved.toml", other);
  const Outcome outcome = run_polyslip({"run", "--restart", "run"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("checkpoint of another deck"), std::string::npos) << outcome.err;
}

TEST_F(Folder, WhoseCurveIsGoneOrTooShort) {
  const std::string curve = slurp(sandbox.path() / "run/macro.csv");
  const auto rows = std::count(curve.begin(), curve.end(), '\n') - 1;
  sandbox.write("run/macro.csv", curve.substr(0, curve.find('\n') + 1));
  restart_rejected("run/macro.csv: has 0 rows where the checkpoint needs " + std::to_string(rows) +
                   "; run anew");
  sandbox.write("run/macro.csv", "strain,stress\n");
  restart_rejected("run/macro.csv: is not the macro.csv of a run (first line)");
  fs::remove(sandbox.path() / "run/macro.csv");
  restart_rejected("run/macro.csv: no such file");
}

TEST_F(Folder, WhoseStoredStatesAreGone) {
  sandbox.write("run/macro.csv", slurp(sandbox.path() / "run/macro.csv") + "torn");
  fs::remove(sandbox.path() / "run/results/state-0001.h5");
  restart_rejected("run/results/state-0001.h5: no such file; put it back or run anew");
}

TEST_F(Folder, ToConvertHoldsNoResults) {
  fs::create_directory(sandbox.path() / "empty");
  for (const std::string folder : {"nowhere", "empty", "deck.toml"})
    convert_rejected(folder, "x.csv",
                     folder + ": holds no stored state; give the folder of a run that has begun");
}

TEST_F(Folder, ToConvertHoldsADamagedState) {
  const std::string state = slurp(sandbox.path() / "run/results/state-0000.h5");
  sandbox.write("run/results/state-0000.h5", state.substr(0, 5000));
  convert_rejected(
      "run", "x.csv",
      "run/results/state-0000.h5: is damaged (4488 bytes after the header instead of " +
          std::to_string(state.size() - 512) +
          "); restart from a checkpoint before it or run anew");
}

TEST_F(Folder, ToConvertIntoCannotBeWrittenTo) {
  for (const std::string to : {"nowhere/x.csv", "deck.toml/x.csv"})
    convert_rejected("run", to, to + ": cannot write; is there such a folder?");
  convert_rejected("run", "run", "run: is a folder; give the name of a file with --to");
}

/// A slip of the pen must not cost a run its curve.
TEST_F(Folder, ToConvertIntoHoldsAnotherFileOfThatName) {
  convert_rejected("run", "run/macro.csv",
                   "run/macro.csv: is there and is no table of elements; give another name with "
                   "--to, or replace it with --overwrite");
}

TEST_F(Folder, ConvertReplacesATableOfItsOwn) {
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome =
        run_polyslip({"convert", "run", "--at-strain", "0", "--to", "x.csv"}, sandbox.path());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
}

TEST(CommandLine, ThatCannotBeUnderstood) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{}, "A subcommand is required"},
      {{"fly"},
       "unknown verb 'fly'; there are run, check, mesh, taylor, analyse, compare, convert, stats, "
       "report, "
       "reference"},
      {{"run"}, "run: a deck, or --restart DIR, is required"},
      {{"run", "deck.toml", "--threads", "0"}, "--threads: Value 0 not in range 1 to 1024"},
      {{"run", "deck.toml", "--threads", "two"}, "--threads: Value two not in range 1 to 1024"},
      {{"run", "deck.toml", "--restart", "run"}, "deck excludes --restart"},
      {{"run", "deck.toml", "extra"}, "The following argument was not expected: extra"},
      {{"run", "--restart", "run", "--overwrite"},
       "run: --restart goes on with a run; it cannot --overwrite it"},
      {{"mesh", "deck.toml"}, "--out is required"},
      {{"convert", "run", "--to", "x.csv"},
       "convert: give a file to read and one to write, or a run folder with --at-strain and --to"},
      {{"convert", "run", "--at-strain", "zero", "--to", "x.csv"},
       "Could not convert: --at-strain = zero"},
      {{"convert", "run", "--at-strain", "0", "--to", "x.csv", "--value", "nonsense"},
       "--value: nonsense not in {average,centroid}"},
  };
  for (const auto& [arguments, what] : wrong)
    expect_rejection(sandbox, arguments, "polyslip: " + what + " (polyslip --help)");
}

/// On several ranks the line comes once.
TEST(CommandLine, ErrorsAreSaidOnceOnTwoRanks) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "[mesh]\nelement_size = -1.0\n");
  const auto before = tree(sandbox.path());
  const Outcome outcome =
      run_program(on_ranks(2, {"run", "deck.toml", "--out", "out"}), sandbox.path());
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  const std::string line = "deck.toml:2:16: [mesh] element_size = -1.0 must be >= 0.01 and <= 10\n";
  const auto at = outcome.err.find(line);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(line, at + 1), std::string::npos) << outcome.err;
  EXPECT_EQ(tree(sandbox.path()), before);
}

}  // namespace
}  // namespace polyslip::tests
