#include "core/timer.hpp"

#include <sys/resource.h>

#include <chrono>

namespace polyslip::core {

namespace {

rusage usage(int who) {
  rusage u{};
  ::getrusage(who, &u);  // fails only for a wrong `who`
  return u;
}

double cpu_seconds(int who) {
  const rusage u = usage(who);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(u.ru_utime) + seconds(u.ru_stime);
}

}  // namespace

double process_cpu_seconds() { return cpu_seconds(RUSAGE_SELF); }

double children_cpu_seconds() { return cpu_seconds(RUSAGE_CHILDREN); }

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double peak_rss_mb() {
  return static_cast<double>(usage(RUSAGE_SELF).ru_maxrss) * 1024 / 1e6;  // Linux gives KiB
}

StageTimes::Measure::Measure(StageTimes& times, std::string stage, bool with_children)
    : times_(times), stage_(std::move(stage)), with_children_(with_children), start_(now()) {}

StageTimes::Measure::~Measure() { times_.add(stage_, now() - start_); }

double StageTimes::Measure::now() const {
  return process_cpu_seconds() + (with_children_ ? children_cpu_seconds() : 0);
}

void StageTimes::add(const std::string& stage, double seconds) {
  for (auto& [name, sum] : stages_)
    if (name == stage) {
      sum += seconds;
      return;
    }
  stages_.emplace_back(stage, seconds);
}

double StageTimes::seconds(const std::string& stage) const {
  for (const auto& [name, sum] : stages_)
    if (name == stage) return sum;
  return 0;
}

}  // namespace polyslip::core
