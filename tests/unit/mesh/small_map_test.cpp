#include "mesh/small_map.hpp"

#include <gtest/gtest.h>

#include <map>

namespace polyslip::mesh {
namespace {

TEST(SmallMap, KeepsTheFirstValueOfEachKeyWhateverItWasMadeFor) {
  for (const std::size_t expected : {0u, 10u, 5000u}) {
    SmallMap map(expected);
    std::map<std::uint64_t, int> truth;
    for (int i = 0; i < 5000; ++i) {
      // Keys that differ in their upper bits only, and repeat.
      const std::uint64_t key = static_cast<std::uint64_t>(i * 7919 % 1300) << (i % 3 * 20);
      const auto [value, added] = map.insert(key, i);
      const auto [at, fresh] = truth.try_emplace(key, i);
      ASSERT_EQ(added, fresh);
      ASSERT_EQ(value, at->second);
    }
    EXPECT_GT(truth.size(), 2000u);
  }
}

TEST(SmallMap, APairIsTheSameEitherWay) {
  EXPECT_EQ(pair_key(3, 8), pair_key(8, 3));
  EXPECT_NE(pair_key(3, 8), pair_key(3, 9));
  EXPECT_NE(pair_key(0, 1), pair_key(1, 1));
}

}  // namespace
}  // namespace polyslip::mesh
