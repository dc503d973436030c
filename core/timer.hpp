#pragma once
// CPU seconds by stage, wall time, peak memory. For reports only: nothing is decided by a clock.

#include <string>
#include <utility>
#include <vector>

namespace polyslip::core {

/// User and system CPU seconds of this process, all threads.
double process_cpu_seconds();
/// User and system CPU seconds of children that have ended and been waited for.
double children_cpu_seconds();
/// Seconds of a clock that never goes back, from an arbitrary start.
double wall_seconds();
/// Largest resident set of this process so far [MB, 1e6 bytes].
double peak_rss_mb();

/// CPU seconds by named stage, in the order in which the stages first appeared.
class StageTimes {
 public:
  /// Adds the time until it goes out of scope to a stage. Stages must not overlap, or their sum
  /// counts twice.
  class Measure {
   public:
    Measure(StageTimes& times, std::string stage, bool with_children);
    ~Measure();
    Measure(const Measure&) = delete;
    Measure& operator=(const Measure&) = delete;

   private:
    double now() const;
    StageTimes& times_;
    std::string stage_;
    bool with_children_;
    double start_;
  };

  /// `auto m = times.measure("meshing", true);`
  Measure measure(std::string stage, bool with_children = false) {
    return Measure(*this, std::move(stage), with_children);
  }
  void add(const std::string& stage, double seconds);
  /// 0 for a stage never measured.
  double seconds(const std::string& stage) const;
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace polyslip::core
