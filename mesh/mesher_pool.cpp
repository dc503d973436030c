#include <fmt/core.h>
#include <fmt/ranges.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <list>
#include <memory>
#include <thread>

#include "core/error.hpp"
#include "mesh/candidate.hpp"
#include "mesh/mesher_spawner.hpp"
#include "mesh/mesher_task.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {
namespace {

/// Grains that one child meshes one after the other: enough to hide the cost of a fork, few enough
/// to keep the jobs busy. Fixed, so that no state of the libraries can make the number of jobs
/// show.
constexpr std::size_t batch_size = 25;

/// Batches that may be on their way, so that one that waits for a hanging mesher does not hold up
/// the others, and what is known of grains stays little.
constexpr std::size_t most_batches = 400;

/// A grain's candidates: the best so far and the faults, by mesher.
struct Candidates {
  bool any = false;
  std::size_t mesher = 0;
  double least = 0;  // worst radius ratio
  double O = 0;
  VolumeMesh mesh;
  std::vector<std::string> faults;  // [meshers], empty: none

  /// Whichever order candidates come in, the same one wins.
  void offer(std::size_t from, VolumeMesh&& candidate, double element_size) {
    const double ratio = min_radius_ratio(candidate);
    const double quality = mesh_quality_O(candidate, element_size);
    const auto now = rank_of(least, O), then = rank_of(ratio, quality);
    if (any && (now > then || (now == then && mesher <= from))) return;
    any = true;
    mesher = from;
    least = ratio;
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
  if (!(options.target > 0) || options.target > 1)
    throw core::InputError(
        fmt::format("mesher target {} must be above 0 and at most 1", options.target));
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
  double six_volumes = 0;
  const core::Vec3& origin = surface.nodes.front();
  for (const auto& t : surface.triangles)
    six_volumes += (surface.nodes[t[0]] - origin)
                       .cross(surface.nodes[t[1]] - origin)
                       .dot(surface.nodes[t[2]] - origin);
  if (!(six_volumes > 0))
    return fmt::format("its surface is inside out or flat, it encloses {:.3g}", six_volumes / 6);
  return {};
}

/// Grains on their way to one mesher.
struct Batch {
  std::vector<std::size_t> places;     // among all requests
  std::vector<GrainRequest> requests;  // [places]
  std::vector<Candidates> candidates;  // [places]
  std::unique_ptr<MesherTask> task;    // none: not started

  bool finished() const { return task && task->finished(); }
};

GrainResult result_of(const GrainRequest& request, Candidates& from, const PoolOptions& options) {
  GrainResult result;
  result.grain = request.grain;
  for (auto& fault : from.faults)
    if (!fault.empty()) result.faults.push_back(std::move(fault));
  result.ok = from.any;
  if (!from.any) return result;
  result.mesh = std::move(from.mesh);
  result.mesher = options.meshers[from.mesher];
  result.O = from.O;
  return result;
}

}  // namespace

/// The way of all grains through the meshers, one after the other: each mesher has a line of
/// batches, and grains leave the first of them for the next line in their order, whichever batch is
/// meshed first. So what is in a batch depends on nothing but the requests.
class MesherPool::Stream {
 public:
  Stream(Impl& pool, std::size_t count, const RequestSource& source, const ResultSink& sink,
         const PoolOptions& options)
      : pool_(pool),
        count_(count),
        source_(source),
        sink_(sink),
        options_(options),
        lines_(options.meshers.size()),
        gathering_(options.meshers.size()) {}

  void run();

 private:
  std::size_t batches() const;
  void refill();
  bool read_batch();
  void close_batch(std::size_t mesher);
  Batch* start_next();
  void start(Batch& batch, std::size_t mesher);
  double size_of(const GrainRequest& request) const;
  bool is_good_enough(const GrainRequest& request, const Candidates& candidates) const;
  void pass_on();
  void pass_on(std::size_t mesher, Batch& batch);

  Impl& pool_;
  std::size_t count_, asked_ = 0;
  const RequestSource& source_;
  const ResultSink& sink_;
  const PoolOptions& options_;
  std::vector<std::list<Batch>> lines_;  // [meshers]
  std::vector<Batch> gathering_;         // [meshers] the last of the line, not yet full
  std::list<MesherTask*> running_;
};

struct MesherPool::Impl {
  explicit Impl(const std::string& executable) : spawner(executable) {}

  void wait(const std::list<MesherTask*>& running);
  void take_reports(const std::list<MesherTask*>& running);
  void take_report(const protocol::ControlMessage& message, MesherTask& task);

  Spawner spawner;
  std::uint32_t tokens = 0;
  double cpu_seconds = 0;
};

void MesherPool::Stream::run() {
  const std::size_t jobs = job_count(options_);
  try {
    for (;;) {
      while (running_.size() < jobs) {
        Batch* batch = start_next();
        if (!batch) break;
        running_.push_back(batch->task.get());
      }
      for (MesherTask* task : running_)
        if (!task->running()) task->start(pool_.spawner, ++pool_.tokens);
      if (running_.empty()) return;
      refill();  // while the meshers work
      pool_.wait(running_);
      running_.remove_if([](const MesherTask* task) { return task->finished(); });
      pass_on();
    }
  } catch (const core::RecoverableError&) {
    for (MesherTask* task : running_)
      if (task->running()) pool_.spawner.kill_child(task->token());
    throw;
  }
}

std::size_t MesherPool::Stream::batches() const {
  std::size_t count = 0;
  for (const auto& line : lines_) count += line.size();
  return count;
}

/// One batch ready for the first mesher, if there are grains left and room for them.
void MesherPool::Stream::refill() {
  auto& line = lines_.front();
  if (!line.empty() && !line.back().task) return;
  if (batches() < most_batches) read_batch();
}

/// False if there was nothing left to read.
bool MesherPool::Stream::read_batch() {
  Batch& batch = gathering_.front();
  while (asked_ < count_ && batch.places.size() < batch_size) {
    const std::size_t place = asked_++;
    GrainRequest request = source_(place);
    Candidates candidates;
    candidates.faults.resize(options_.meshers.size());
    if (const std::string fault = surface_fault(request.surface); !fault.empty()) {
      candidates.faults[0] = fmt::format("grain {}: {}", request.grain + 1, fault);
      sink_(place, result_of(request, candidates, options_));
      continue;
    }
    batch.places.push_back(place);
    batch.requests.push_back(std::move(request));
    batch.candidates.push_back(std::move(candidates));
  }
  if (batch.places.empty()) return false;
  close_batch(0);
  return true;
}

void MesherPool::Stream::close_batch(std::size_t mesher) {
  lines_[mesher].push_back(std::move(gathering_[mesher]));
  gathering_[mesher] = {};
}

/// Grains that have come further go first; their mesh is then soon off our hands.
Batch* MesherPool::Stream::start_next() {
  for (std::size_t m = lines_.size(); m-- > 0;)
    for (auto& batch : lines_[m])
      if (!batch.task) {
        start(batch, m);
        return &batch;
      }
  if (batches() >= most_batches || !read_batch()) return nullptr;
  start(lines_.front().back(), 0);
  return &lines_.front().back();
}

void MesherPool::Stream::start(Batch& batch, std::size_t mesher) {
  const auto take_mesh = [&batch, mesher, this](std::size_t i, VolumeMesh&& mesh) {
    batch.candidates[i].offer(mesher, std::move(mesh), size_of(batch.requests[i]));
  };
  const auto take_fault = [&batch, mesher](std::size_t i, const std::string& why) {
    batch.candidates[i].faults[mesher] = why;
  };
  batch.task = std::make_unique<MesherTask>(
      batch.requests, 0, batch.places.size(), options_.meshers[mesher], options_.element_size,
      options_.timeout, MesherTask::Sink{take_mesh, take_fault});
}

double MesherPool::Stream::size_of(const GrainRequest& request) const {
  return request.element_size > 0 ? request.element_size : options_.element_size;
}

bool MesherPool::Stream::is_good_enough(const GrainRequest& request,
                                        const Candidates& candidates) const {
  return candidates.any && is_good(surface_bounds(request.surface, size_of(request)),
                                   candidates.least, candidates.O, options_.target);
}

void MesherPool::Stream::pass_on() {
  bool none_before = asked_ == count_;
  for (std::size_t m = 0; m < lines_.size(); ++m) {
    auto& line = lines_[m];
    if (none_before && !gathering_[m].places.empty()) close_batch(m);
    while (!line.empty() && line.front().finished()) {
      pass_on(m, line.front());
      line.pop_front();
    }
    none_before = none_before && line.empty();
  }
}

void MesherPool::Stream::pass_on(std::size_t mesher, Batch& batch) {
  for (std::size_t i = 0; i < batch.places.size(); ++i) {
    if (mesher + 1 == lines_.size() || is_good_enough(batch.requests[i], batch.candidates[i])) {
      sink_(batch.places[i], result_of(batch.requests[i], batch.candidates[i], options_));
      continue;
    }
    Batch& next = gathering_[mesher + 1];
    next.places.push_back(batch.places[i]);
    next.requests.push_back(std::move(batch.requests[i]));
    next.candidates.push_back(std::move(batch.candidates[i]));
    if (next.places.size() == batch_size) close_batch(mesher + 1);
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

MesherPool::MesherPool(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MesherPool::~MesherPool() = default;

std::unique_ptr<MesherPool> MesherPool::start(const std::string& worker_executable) {
  return std::unique_ptr<MesherPool>(new MesherPool(std::make_unique<Impl>(worker_executable)));
}

double MesherPool::cpu_seconds() const { return impl_->cpu_seconds; }

std::vector<GrainResult> MesherPool::mesh(const std::vector<GrainRequest>& requests,
                                          const PoolOptions& options) {
  std::vector<GrainResult> results(requests.size());
  mesh(
      requests.size(), [&](std::size_t i) { return requests[i]; },
      [&](std::size_t i, GrainResult&& result) { results[i] = std::move(result); }, options);
  return results;
}

void MesherPool::mesh(std::size_t count, const RequestSource& source, const ResultSink& sink,
                      const PoolOptions& options) {
  check_options(options);
  Stream(*impl_, count, source, sink, options).run();
}

}  // namespace polyslip::mesh
