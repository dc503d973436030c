#include "solver/profile.hpp"

#include <fmt/format.h>
#include <petsclog.h>
#include <petscviewer.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "core/timer.hpp"
#include "solver/exchange.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {
namespace {

void push_petsc_stage(const char* name) {
  PetscLogStage stage = -1;
  check(PetscLogStageGetId(name, &stage));
  if (stage < 0) check(PetscLogStageRegister(name, &stage));
  check(PetscLogStagePush(stage));
}

}  // namespace

void Profile::log_with_petsc() {
  check(PetscLogDefaultBegin());
  petsc_ = true;
}

void Profile::clear() {
  const bool petsc = petsc_;
  *this = {};
  petsc_ = petsc;
}

void Profile::charge() {
  const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  const double wall = core::wall_seconds();
  if (!open_.empty()) {
    open_.back().cpu += cpu - cpu_;
    open_.back().wall += wall - wall_;
  }
  cpu_ = cpu;
  wall_ = wall;
}

void Profile::enter(const char* stage) {
  charge();
  open_.push_back({stage, 0, 0});
  if (petsc_) push_petsc_stage(stage);
}

void Profile::leave() {
  charge();
  if (petsc_) static_cast<void>(PetscLogStagePop());  // called by a destructor: no throw
  const Open done = open_.back();
  open_.pop_back();
  for (Entry& e : entries_) {
    if (e.stage != done.stage) continue;
    e.cpu += done.cpu;
    e.wall += done.wall;
    ++e.calls;
    return;
  }
  entries_.push_back({done.stage, done.cpu, done.wall, 1});
}

namespace {

Profile::Entry entry_of(const Profile& profile, const std::string& stage) {
  for (const auto& e : profile.entries())
    if (e.stage == stage) return e;
  return {stage, 0, 0, 0};
}

/// Names of rank 0's stages on every rank, the dearest of that rank first.
std::vector<std::string> stages_of_root(const Profile& profile, MPI_Comm comm) {
  std::vector<Profile::Entry> entries = profile.entries();
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.cpu > b.cpu; });
  std::string names;
  for (const auto& e : entries) names += e.stage + '\n';
  int length = broadcast(comm, static_cast<int>(names.size()));
  names.resize(static_cast<std::size_t>(length));
  MPI_Bcast(names.data(), length, MPI_CHAR, 0, comm);
  std::vector<std::string> stages;
  for (std::size_t at = 0, end; (end = names.find('\n', at)) != std::string::npos; at = end + 1)
    stages.push_back(names.substr(at, end - at));
  return stages;
}

}  // namespace

std::string profile_text(const Profile& profile, MPI_Comm comm) {
  const auto stages = stages_of_root(profile, comm);
  std::vector<std::array<double, 4>> rows;  // CPU of all ranks, of the slowest; wall; calls
  double total = 0;
  for (const auto& stage : stages) {
    const auto e = entry_of(profile, stage);
    rows.push_back({sum(comm, e.cpu), maximum(comm, e.cpu), maximum(comm, e.wall),
                    static_cast<double>(e.calls)});
    total += rows.back()[0];
  }
  double sent[2] = {static_cast<double>(profile.messages()), static_cast<double>(profile.bytes())};
  const double most = maximum(comm, sent[1]);
  sum(comm, sent, 2);
  if (rank_of(comm) != 0) return {};
  std::string text = fmt::format("{:<20} {:>10} {:>7} {:>12} {:>12} {:>9}\n", "stage", "CPU s", "%",
                                 "CPU s a rank", "wall s", "calls");
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += fmt::format("{:<20} {:>10.3f} {:>7.2f} {:>12.3f} {:>12.3f} {:>9.0f}\n", stages[i],
                        rows[i][0], total > 0 ? 100 * rows[i][0] / total : 0, rows[i][1],
                        rows[i][2], rows[i][3]);
  text += fmt::format(
      "between the {} ranks: {:.0f} messages of {:.0f} bytes on average, {:.3f} MB from the rank "
      "that sends most, {} reductions\n",
      size_of(comm), sent[0], sent[0] > 0 ? sent[1] / sent[0] : 0, 1e-6 * most,
      profile.reductions());
  return text;
}

void write_petsc_log(const std::string& path) {
  ViewerHandle viewer;
  check(PetscViewerASCIIOpen(PETSC_COMM_WORLD, path.c_str(), viewer.out()));
  check(PetscLogView(viewer.get()));
}

}  // namespace polyslip::solver
