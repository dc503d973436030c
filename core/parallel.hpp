#pragma once
// Loops over independent items on the threads of one process.

#include <cstddef>
#include <functional>

namespace polyslip::core {

/// Number of threads for `jobs` as a user gives it: 0 means one a core.
int thread_count(int jobs);

/// Calls body(i) for each i in [0, count), on up to `threads` threads. The items must not depend on
/// each other; then the result is the same for any number of threads. If items throw, the exception
/// of the lowest of those that were reached is thrown when all threads are done.
void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace polyslip::core
