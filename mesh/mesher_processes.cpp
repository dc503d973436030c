#include "mesh/mesher_processes.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <vector>

#include "core/error.hpp"

namespace polyslip::mesh {

std::size_t job_count(int jobs) {
  const int wanted = jobs > 0 ? jobs : static_cast<int>(std::thread::hardware_concurrency());
  return static_cast<std::size_t>(std::clamp(wanted, 1, protocol::max_children / 2));
}

void MesherPool::Impl::run(std::size_t jobs, const std::function<MesherTask*()>& next,
                           const std::function<void()>& refill,
                           const std::function<void()>& ended) {
  std::list<MesherTask*> running;
  try {
    for (;;) {
      while (running.size() < jobs) {
        MesherTask* task = next();
        if (!task) break;
        running.push_back(task);
      }
      for (MesherTask* task : running)
        if (!task->running()) task->start(spawner, ++tokens);
      if (running.empty()) return;
      refill();
      wait(running);
      running.remove_if([](const MesherTask* task) { return task->finished(); });
      ended();
    }
  } catch (const core::RecoverableError&) {
    for (MesherTask* task : running)
      if (task->running()) spawner.kill_child(task->token());
    throw;
  }
}

void MesherPool::Impl::wait(const std::list<MesherTask*>& running) {
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

void MesherPool::Impl::take_reports(const std::list<MesherTask*>& running) {
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

}  // namespace polyslip::mesh
