// A run through everything that can befall it: killed at random moments, out of space.

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>

#include "results/names.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Eight grains to 0.06, remeshed by itself, with failed steps and reversals left out.
const std::string worn_deck =
    "[polycrystal]\ngrains = 8\nseed = 1\n[mesh]\nelement_size = 0.8\nmeshers = [\"gmsh-hxt\"]\n"
    "[loading]\nfinal_strain = 0.06\nmax_strain_increment = 0.01\n"
    "[remeshing]\nradius_ratio_share = 0.995\nmin_interval = 0.025\n"
    "[output]\nat_strains = [0.02]\ncheckpoint_every_strain = 0.01\n";

void expect_same_end(const fs::path& a, const fs::path& b) {
  EXPECT_GT(line_count(a / "macro.csv"), 20);
  for (const auto* file : {"macro.csv", "results.xdmf", "results/index.json"})
    EXPECT_EQ(slurp(a / file), slurp(b / file)) << file;
  ASSERT_EQ(state_count(a), state_count(b));
  for (std::size_t i = 0; i < state_count(a); ++i) expect_identical(state_of(a, i), state_of(b, i));
}

/// Twenty kills, each after a random share of the time that the whole run takes; a run that is
/// quicker than that is not killed, and does not count.
TEST(Survival, OfTwentyKillsAtRandomMoments) {
  Sandbox sandbox;
  const auto start = Clock::now();
  run_deck(sandbox, 0, worn_deck, "undisturbed");
  ASSERT_FALSE(HasFailure());
  const double duration = std::chrono::duration<double>(Clock::now() - start).count();
  sandbox.write("killed.toml", worn_deck);
  std::mt19937_64 random(20111);
  std::uniform_real_distribution<double> share(0.02, 0.9);
  std::vector<std::string> arguments{"run", "killed.toml", "--out", "killed"};
  int killed = 0;
  for (int tries = 0; killed < 20 && tries < 80; ++tries) {
    Program program(on_ranks(0, arguments), sandbox.path());
    eventually(duration * share(random), [&] { return program.ended(); });
    program.kill({});
    const Outcome outcome = program.wait();
    killed += outcome.code == 128 + SIGKILL;
    ASSERT_TRUE(outcome.code == 128 + SIGKILL || outcome.code == 0) << outcome.err;
    // Before the folder has its deck there is nothing to go on with.
    const bool begun = fs::exists(sandbox.path() / "killed/deck.resolved.toml");
    arguments =
        begun ? std::vector<std::string>{"run", "--restart", "killed"}
              : std::vector<std::string>{"run", "killed.toml", "--out", "killed", "--overwrite"};
    // A run that has ended begins anew, so that every kill hits something.
    if (outcome.code == 0) arguments = {"run", "killed.toml", "--out", "killed", "--overwrite"};
  }
  EXPECT_EQ(killed, 20);
  const Outcome outcome = run_polyslip(arguments, sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  expect_same_end(sandbox.path() / "undisturbed", sandbox.path() / "killed");
}

bool has_parts(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".part") return true;
  return false;
}

/// A file system in memory of a few megabytes, for as long as it lives.
class SmallDisk {
 public:
  explicit SmallDisk(const fs::path& place) : place_(place) {
    fs::create_directories(place_);
    mounted_ = ::mount("tmpfs", place_.c_str(), "tmpfs", 0, "size=2m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }
  bool grow() const {
    return ::mount("tmpfs", place_.c_str(), "tmpfs", MS_REMOUNT, "size=64m") == 0;
  }

 private:
  fs::path place_;
  bool mounted_ = false;
};

TEST(Survival, OfAFullDisk) {
  Sandbox sandbox;
  const SmallDisk disk(sandbox.path() / "disk");
  if (!disk.mounted()) GTEST_SKIP() << "needs the right to mount a file system";
  run_deck(sandbox, 0, worn_deck, "undisturbed");
  ASSERT_FALSE(HasFailure());
  sandbox.write("disk.toml", worn_deck);
  const Outcome outcome = run_polyslip({"run", "disk.toml", "--out", "disk/run"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("No space left on device"), std::string::npos) << outcome.err;
  EXPECT_FALSE(has_parts(sandbox.path() / "disk/run"));
  ASSERT_TRUE(disk.grow());
  const Outcome rest = run_polyslip({"run", "--restart", "disk/run"}, sandbox.path());
  ASSERT_EQ(rest.code, 0) << rest.err;
  expect_same_end(sandbox.path() / "undisturbed", sandbox.path() / "disk/run");
}

}  // namespace
}  // namespace polyslip::tests
