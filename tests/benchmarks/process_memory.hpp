#pragma once
// Memory of a program and all the processes that it starts.

#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>

namespace polyslip::benchmarks {

namespace fs = std::filesystem;

/// Number behind `key` in a file of lines "key: number kB"; 0 if there is none.
inline long field(const fs::path& path, const std::string& key) {
  std::ifstream in(path);
  std::string word;
  long value = 0;
  while (in >> word)
    if (word == key && in >> value) return value;
  return 0;
}

/// A process and all its descendants.
inline std::set<pid_t> family(pid_t root) {
  std::map<pid_t, pid_t> parents;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    parents[std::stoi(name)] = static_cast<pid_t>(field(entry.path() / "status", "PPid:"));
  }
  std::set<pid_t> members{root};
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& [pid, parent] : parents)
      if (members.count(parent)) grew |= members.insert(pid).second;
  }
  return members;
}

/// Proportional set sizes [MB, 1e6 bytes]: shared pages count once among those that share them.
struct Memory {
  double main = 0, all = 0;
};

inline Memory memory_of(pid_t root) {
  Memory memory;
  for (const pid_t pid : family(root)) {
    const auto file = fs::path("/proc") / std::to_string(pid) / "smaps_rollup";
    const double size = 1.024e-3 * static_cast<double>(field(file, "Pss:"));
    memory.all += size;
    if (pid == root) memory.main = size;
  }
  return memory;
}

/// Peak of the memory of this process and its descendants while it lives, looked at at intervals.
class MemoryWatch {
 public:
  explicit MemoryWatch(double interval = 0.05)
      : thread_([this, interval] {
          for (; !ended_; std::this_thread::sleep_for(std::chrono::duration<double>(interval)))
            peak_ = std::max(peak_, memory_of(::getpid()).all);
        }) {}
  /// Ends the watch; MB.
  double peak() {
    end();
    return peak_;
  }
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;
  ~MemoryWatch() { end(); }

 private:
  void end() {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::atomic<bool> ended_{false};
  double peak_ = 0;
  std::thread thread_;
};

}  // namespace polyslip::benchmarks
