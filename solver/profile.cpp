#include "solver/profile.hpp"

#include <ctime>

#include "core/timer.hpp"

namespace polyslip::solver {

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
}

void Profile::leave() {
  charge();
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

}  // namespace polyslip::solver
