#pragma once
// A table of some hundred whole numbers, for what is looked up once a grain.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace polyslip::mesh {

/// Open addressing, linear probing; looked up only, never walked through. Keys are below 2^64 - 1.
class SmallMap {
 public:
  explicit SmallMap(std::size_t expected) { resize(std::bit_ceil(2 * expected + 16)); }

  /// The value of a key, which gets `fallback` if it has none; whether it had none.
  std::pair<int, bool> insert(std::uint64_t key, int fallback) {
    if (2 * count_ >= keys_.size()) grow();
    const std::size_t at = place(key);
    if (keys_[at] == key) return {values_[at], false};
    keys_[at] = key;
    values_[at] = fallback;
    ++count_;
    return {fallback, true};
  }

 private:
  static constexpr std::uint64_t free = ~std::uint64_t{0};

  std::size_t place(std::uint64_t key) const {
    // Fibonacci hashing: the upper bits of the product.
    std::size_t at = key * 0x9E3779B97F4A7C15u >> shift_;
    while (keys_[at] != key && keys_[at] != free) at = (at + 1) & (keys_.size() - 1);
    return at;
  }
  void resize(std::size_t capacity) {
    keys_.assign(capacity, free);
    values_.assign(capacity, 0);
    shift_ = 64 - std::countr_zero(capacity);
  }
  void grow() {
    const auto keys = std::move(keys_);
    const auto values = std::move(values_);
    resize(2 * keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] != free) {
        const std::size_t at = place(keys[i]);
        keys_[at] = keys[i];
        values_[at] = values[i];
      }
  }

  std::vector<std::uint64_t> keys_;
  std::vector<int> values_;
  std::size_t count_ = 0;
  int shift_ = 0;
};

/// Two nodes, whichever comes first, as one number.
inline std::uint64_t pair_key(int a, int b) {
  if (a > b) std::swap(a, b);
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

}  // namespace polyslip::mesh
