#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <memory>

#include "core/error.hpp"
#include "mesh/candidate.hpp"
#include "mesh/mesher_processes.hpp"
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
};

void MesherPool::Stream::run() {
  const auto start = [this]() -> MesherTask* {
    Batch* batch = start_next();
    return batch ? batch->task.get() : nullptr;
  };
  pool_.run(
      job_count(options_.jobs), start, [this] { refill(); }, [this] { pass_on(); });
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
  MesherWork work;
  work.mesher = options_.meshers[mesher];
  work.timeout = options_.timeout;
  work.count = batch.places.size();
  work.encode = [&batch, work, this](std::size_t first) {
    protocol::Batch left{work.mesher, options_.element_size, work.timeout, options_.optimise, {}};
    left.grains.assign(batch.requests.begin() + static_cast<std::ptrdiff_t>(first),
                       batch.requests.end());
    return protocol::encode(left);
  };
  work.name = [&batch](std::size_t i) {
    return fmt::format("grain {}", batch.requests[i].grain + 1);
  };
  work.take = [&batch, mesher, this](std::size_t i, const protocol::Bytes& answer) {
    VolumeMesh mesh = protocol::decode_mesh(answer);
    std::string fault = validate(batch.requests[i].surface, mesh);
    if (fault.empty())
      batch.candidates[i].offer(mesher, std::move(mesh), size_of(batch.requests[i]));
    return fault;
  };
  work.take_fault = [&batch, mesher](std::size_t i, const std::string& why) {
    batch.candidates[i].faults[mesher] = why;
  };
  batch.task = std::make_unique<MesherTask>(std::move(work));
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
