#pragma once
// What a pool of meshers holds: the process that starts them, and the loop around those at work.

#include <functional>
#include <list>
#include <string>

#include "mesh/mesher_spawner.hpp"
#include "mesh/mesher_task.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Mesher processes at once for `jobs` of the options.
std::size_t job_count(int jobs);

struct MesherPool::Impl {
  explicit Impl(const std::string& executable) : spawner(executable) {}

  /// Keeps up to `jobs` tasks at work until `next` has no more (nullptr). While they work `refill`
  /// is called, and `ended` whenever some may have ended. Tasks must live until then. Throws
  /// RecoverableError, with no task at work, if the machine has no process.
  void run(std::size_t jobs, const std::function<MesherTask*()>& next,
           const std::function<void()>& refill, const std::function<void()>& ended);

  Spawner spawner;
  std::uint32_t tokens = 0;
  double cpu_seconds = 0;

 private:
  void wait(const std::list<MesherTask*>& running);
  void take_reports(const std::list<MesherTask*>& running);
  void take_report(const protocol::ControlMessage& message, MesherTask& task);
};

}  // namespace polyslip::mesh
