// Random small runs (random_deck.hpp). Each must come to its end, or stop with the reason and a
// state from which --restart goes on, to stop again or end; nothing else is right.
//   random_decks [first seed] [number of runs] [folder for runs that went wrong]
// A line for each run; ends with 1 if one went wrong.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "random_deck.hpp"
#include "results/checkpoint.hpp"
#include "support/program.hpp"

namespace {

namespace fs = std::filesystem;
using namespace polyslip;
using tests::Outcome;

constexpr int ended = 0, stopped = 3;
constexpr const char* longest = "900";  // s of a run, on a busy machine

/// What is wrong with a finished or stopped run; empty if nothing is.
std::string fault_of(const fs::path& run, int code) {
  std::ifstream rows(run / "macro.csv");
  std::string line;
  for (long row = 0; std::getline(rows, line); ++row) {
    if (row > 0 && (line.find("nan") != std::string::npos || line.find("inf") != std::string::npos))
      return fmt::format("row {} of macro.csv holds no numbers", row);
  }
  const auto summary = nlohmann::json::parse(tests::slurp(run / "summary.json"), nullptr, false);
  if (summary.is_discarded() || !summary.contains("completed")) return "no summary.json";
  if (summary["completed"].get<bool>() != (code == ended)) return "summary.json says otherwise";
  try {
    if (!results::newest_valid_checkpoint(run.string())) return "no checkpoint";
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string line, last;
  while (std::getline(lines, line)) {
    if (line.find("min_strain_increment") != std::string::npos) return line;
    if (!line.empty()) last = line;
  }
  return last;
}

Outcome polyslip_run(const std::vector<std::string>& arguments, const fs::path& folder) {
  std::vector<std::string> all = {"/usr/bin/env", "timeout", "--signal=KILL", longest};
  const auto program = tests::on_ranks(0, arguments);
  all.insert(all.end(), program.begin(), program.end());
  return tests::run_program(all, folder);
}

/// The number of linear or Newton iterations and of steps, for the line.
std::string counts(const fs::path& run) {
  const auto s = nlohmann::json::parse(tests::slurp(run / "summary.json"), nullptr, false);
  if (s.is_discarded()) return "";
  return fmt::format("{} steps, {} cuts", s.value("steps", -1), s.value("step_cuts", -1));
}

/// True if all is well.
bool try_seed(std::uint64_t seed, const fs::path& keep) {
  const auto deck = tests::random_deck(seed);
  const tests::Sandbox sandbox;
  sandbox.write("deck.toml", deck.text);
  const double start = core::wall_seconds();
  const Outcome outcome = polyslip_run({"run", "deck.toml", "--out", "run"}, sandbox.path());
  const fs::path run = sandbox.path() / "run";
  std::string fault, end = "ended";
  if (outcome.code != ended && outcome.code != stopped)
    fault = fmt::format("exit code {}: {}", outcome.code, last_line(outcome.err));
  else
    fault = fault_of(run, outcome.code);
  if (fault.empty() && outcome.code == stopped) {
    end = "stopped: " + last_line(outcome.err + outcome.out);
    const Outcome again = polyslip_run({"run", "--restart", "run"}, sandbox.path());
    if (again.code != ended && again.code != stopped)
      fault = fmt::format("restart: exit code {}: {}", again.code, last_line(again.err));
    else
      fault = fault_of(run, again.code);
  }
  std::printf("seed %4llu  %s: %s; %s, %.0f s\n", static_cast<unsigned long long>(seed),
              deck.summary.c_str(), fault.empty() ? end.c_str() : ("WRONG: " + fault).c_str(),
              counts(run).c_str(), core::wall_seconds() - start);
  std::fflush(stdout);
  if ((!fault.empty() || outcome.code == stopped) && !keep.empty()) {
    fs::create_directories(keep);
    fs::copy(sandbox.path(), keep / fmt::format("seed-{}", seed),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  return fault.empty();
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const int count = argc > 2 ? std::atoi(argv[2]) : 3;
  const fs::path keep = argc > 3 ? argv[3] : "";
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    if (!try_seed(first + static_cast<std::uint64_t>(i), keep)) ++wrong;
  }
  std::printf("%d of %d runs went wrong\n", wrong, count);
  return wrong == 0 && count > 0 ? 0 : 1;
}
