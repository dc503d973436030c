#include <fmt/core.h>
#include <fmt/ranges.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <list>
#include <thread>
#include <tuple>

#include "core/error.hpp"
#include "mesh/mesher_spawner.hpp"
#include "mesh/mesher_task.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {
namespace {

/// Grains that one child meshes one after the other: enough to hide the cost of a fork, few enough
/// to keep the jobs busy. Fixed, so that no state of the libraries can make the number of jobs
/// show.
constexpr std::size_t batch_size = 25;

constexpr double radius_ratio_floor = 0.2;
constexpr double radius_ratio_step = 0.02;

/// A grain's candidates: the best so far and the faults, by mesher.
struct Candidates {
  bool any = false;
  std::size_t mesher = 0;
  int worst = 0;  // worst radius ratio up to the floor, in steps
  double O = 0;
  VolumeMesh mesh;
  std::vector<std::string> faults;  // [meshers], empty: none

  /// Whichever order candidates come in, the same one wins.
  void offer(std::size_t from, VolumeMesh&& candidate, double element_size) {
    const double least = std::min(min_radius_ratio(candidate), radius_ratio_floor);
    const int steps = static_cast<int>(std::floor(least / radius_ratio_step));
    const double quality = mesh_quality_O(candidate, element_size);
    const auto rank = [](int w, double o, std::size_t m) { return std::tuple(-w, -o, m); };
    if (any && rank(worst, O, mesher) <= rank(steps, quality, from)) return;
    any = true;
    mesher = from;
    worst = steps;
    O = quality;
    mesh = std::move(candidate);
  }
};

void check_options(const PoolOptions& options) {
  if (options.meshers.empty()) throw core::InputError("meshers: the list is empty");
  for (const auto& name : options.meshers)
    if (std::find(known_meshers.begin(), known_meshers.end(), name) == known_meshers.end())
      throw core::InputError(fmt::format("meshers: '{}' is unknown; there are {}", name,
                                         fmt::join(known_meshers, ", ")));
  if (!(options.element_size > 0) || !std::isfinite(options.element_size))
    throw core::InputError(fmt::format("element size {} must be positive", options.element_size));
  if (!(options.timeout > 0) || options.timeout > 1e6)
    throw core::InputError(fmt::format("mesher timeout {} s must be positive", options.timeout));
}

std::size_t job_count(const PoolOptions& options) {
  const int jobs =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::thread::hardware_concurrency());
  return static_cast<std::size_t>(std::clamp(jobs, 1, protocol::max_children / 2));
}

std::string surface_fault(const SurfaceMesh& surface) {
  if (surface.nodes.empty() || surface.triangles.empty()) return "its surface is empty";
  for (std::size_t i = 0; i < surface.nodes.size(); ++i)
    if (!surface.nodes[i].allFinite())
      return fmt::format("node {} of its surface is not finite", i);
  for (const auto& t : surface.triangles)
    for (const int n : t)
      if (n < 0 || n >= static_cast<int>(surface.nodes.size()))
        return fmt::format("its surface names node {} of {}", n, surface.nodes.size());
  return {};
}

std::vector<GrainResult> collect(const std::vector<GrainRequest>& requests,
                                 const PoolOptions& options, std::vector<Candidates>& candidates) {
  std::vector<GrainResult> results(requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    GrainResult& result = results[i];
    Candidates& from = candidates[i];
    result.grain = requests[i].grain;
    for (auto& fault : from.faults)
      if (!fault.empty()) result.faults.push_back(std::move(fault));
    result.ok = from.any;
    if (!from.any) continue;
    result.mesh = std::move(from.mesh);
    result.mesher = options.meshers[from.mesher];
    result.O = from.O;
  }
  return results;
}

}  // namespace

struct MesherPool::Impl {
  explicit Impl(const std::string& executable) : spawner(executable) {}

  /// Runs the tasks, `jobs` at a time, in their order.
  void run(std::list<MesherTask>& tasks, std::size_t jobs);
  void wait(std::list<MesherTask*>& running);
  void take_reports(std::list<MesherTask*>& running);
  void take_report(const protocol::ControlMessage& message, MesherTask& task);

  Spawner spawner;
  std::uint32_t tokens = 0;
  double cpu_seconds = 0;
};

void MesherPool::Impl::run(std::list<MesherTask>& tasks, std::size_t jobs) {
  std::list<MesherTask*> running;
  auto waiting = tasks.begin();
  try {
    while (waiting != tasks.end() || !running.empty()) {
      for (; waiting != tasks.end() && running.size() < jobs; ++waiting)
        running.push_back(&*waiting);
      for (MesherTask* task : running)
        if (!task->running()) task->start(spawner, ++tokens);
      wait(running);
      running.remove_if([](const MesherTask* task) { return task->finished(); });
    }
  } catch (const core::RecoverableError&) {
    for (MesherTask* task : running)
      if (task->running()) spawner.kill_child(task->token());
    throw;
  }
}

void MesherPool::Impl::wait(std::list<MesherTask*>& running) {
  std::vector<pollfd> sources{{spawner.control(), POLLIN, 0}};
  std::vector<MesherTask*> owners{nullptr};
  for (MesherTask* task : running)
    if (task->socket() >= 0) {
      const int events = POLLIN | (task->wants_to_send() ? POLLOUT : 0);
      sources.push_back({task->socket(), static_cast<short>(events), 0});
      owners.push_back(task);
    }
  if (poll(sources.data(), sources.size(), -1) < 0 && errno != EINTR)
    throw core::InternalError("mesher pool: poll failed");
  for (std::size_t i = 1; i < sources.size(); ++i)
    if (sources[i].revents != 0) owners[i]->work(spawner);
  if (sources[0].revents != 0) take_reports(running);
}

void MesherPool::Impl::take_reports(std::list<MesherTask*>& running) {
  while (const auto message = spawner.next_message()) {
    if (message->kind == protocol::Control::ended) cpu_seconds += message->cpu_seconds;
    for (MesherTask* task : running)
      if (task->running() && task->token() == message->token) take_report(*message, *task);
  }
}

void MesherPool::Impl::take_report(const protocol::ControlMessage& message, MesherTask& task) {
  if (message.kind == protocol::Control::ended) task.child_ended(spawner, message.value);
  if (message.kind == protocol::Control::not_forked)
    throw core::RecoverableError(
        fmt::format("no process for a mesher after several tries: {}; free processes or memory, or "
                    "raise the limits (ulimit -u, ulimit -v)",
                    strerror(message.value)));
}

MesherPool::MesherPool(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MesherPool::~MesherPool() = default;

std::unique_ptr<MesherPool> MesherPool::start(const std::string& worker_executable) {
  return std::unique_ptr<MesherPool>(new MesherPool(std::make_unique<Impl>(worker_executable)));
}

double MesherPool::cpu_seconds() const { return impl_->cpu_seconds; }

std::vector<GrainResult> MesherPool::mesh(const std::vector<GrainRequest>& requests,
                                          const PoolOptions& options) {
  check_options(options);
  std::vector<Candidates> candidates(requests.size());
  std::vector<GrainRequest> sound;
  std::vector<std::size_t> place;  // of each sound request among all
  for (std::size_t i = 0; i < requests.size(); ++i) {
    candidates[i].faults.resize(options.meshers.size());
    const std::string fault = surface_fault(requests[i].surface);
    if (fault.empty()) {
      sound.push_back(requests[i]);
      place.push_back(i);
    } else {
      candidates[i].faults[0] = fmt::format("grain {}: {}", requests[i].grain + 1, fault);
    }
  }
  std::list<MesherTask> tasks;
  for (std::size_t first = 0; first < sound.size(); first += batch_size)
    for (std::size_t m = 0; m < options.meshers.size(); ++m)
      tasks.emplace_back(sound, first, std::min(first + batch_size, sound.size()),
                         options.meshers[m], options.element_size, options.timeout,
                         MesherTask::Sink{[&, m](std::size_t i, VolumeMesh&& mesh) {
                                            candidates[place[i]].offer(m, std::move(mesh),
                                                                       options.element_size);
                                          },
                                          [&, m](std::size_t i, const std::string& why) {
                                            candidates[place[i]].faults[m] = why;
                                          }});
  impl_->run(tasks, job_count(options));
  return collect(requests, options, candidates);
}

}  // namespace polyslip::mesh
