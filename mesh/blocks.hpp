#pragma once
// Loops over many small items on several threads.

#include <algorithm>
#include <cstddef>

#include "core/parallel.hpp"

namespace polyslip::mesh {

/// Calls body(first, last) for blocks that make up [0, count); see core::parallel_for.
template <class Body>
void for_blocks(int threads, std::size_t count, const Body& body) {
  constexpr std::size_t block = 2048;
  core::parallel_for(threads, (count + block - 1) / block,
                     [&](std::size_t i) { body(i * block, std::min(count, (i + 1) * block)); });
}

}  // namespace polyslip::mesh
