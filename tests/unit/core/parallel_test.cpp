#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace polyslip::core {
namespace {

TEST(ParallelFor, CallsEachItemOnce) {
  for (const int threads : {1, 2, 5})
    for (const std::size_t count : {0u, 1u, 7u, 1000u}) {
      std::vector<int> calls(count, 0);
      parallel_for(threads, count, [&](std::size_t i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(count, 1));
    }
}

TEST(ParallelFor, HandsOnWhatAnItemThrows) {
  for (const int threads : {1, 3})
    EXPECT_THROW(parallel_for(threads, 100,
                              [](std::size_t i) {
                                if (i == 42) throw std::runtime_error("42");
                              }),
                 std::runtime_error);
}

TEST(ThreadCount, IsOneACoreUnlessAsked) {
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_GE(thread_count(0), 1);
}

}  // namespace
}  // namespace polyslip::core
