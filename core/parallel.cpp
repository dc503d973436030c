#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace polyslip::core {

int thread_count(int jobs) {
  if (jobs > 0) return jobs;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& body) {
  constexpr std::size_t chunk = 8;  // items taken at once
  const std::size_t useful = (count + chunk - 1) / chunk;
  const std::size_t helpers = std::min<std::size_t>(std::max(threads, 1), useful);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t failed = count;
  const auto work = [&] {
    for (std::size_t first = next.fetch_add(chunk); first < count; first = next.fetch_add(chunk))
      for (std::size_t i = first; i < std::min(first + chunk, count); ++i) try {
          body(i);
        } catch (...) {
          const std::lock_guard lock(mutex);
          next = count;
          if (i < failed) {
            failed = i;
            error = std::current_exception();
          }
          break;
        }
  };
  {
    std::vector<std::jthread> pool;
    for (std::size_t i = 1; i < helpers; ++i) pool.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace polyslip::core
