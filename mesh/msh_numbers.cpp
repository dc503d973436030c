#include "mesh/msh_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace polyslip::mesh {

template <class T>
T MshNumbers::take(const char* what) {
  std::array<char, sizeof(T)> buffer;
  std::ranges::copy(in_.bytes(sizeof(T), what), buffer.begin());
  if (swapped_) std::ranges::reverse(buffer);
  T value;
  std::memcpy(&value, buffer.data(), sizeof(T));
  return value;
}

void MshNumbers::end_line() {
  if (!binary_) return;
  in_.rest_of_line();
  in_.bytes(1, "the end of a line");
}

void MshNumbers::begin_binary() {
  binary_ = true;
  end_line();
  const auto one = take<std::int32_t>("the number 1");
  swapped_ = one == 0x01000000;
  if (one != 1 && !swapped_)
    in_.fail(fmt::format("the number 1 that tells the byte order is {}", one));
}

int MshNumbers::integer(const char* what) {
  return binary_ ? take<std::int32_t>(what) : in_.integer(what);
}

int MshNumbers::wide(const char* what) {
  if (!binary_) return in_.integer(what);
  const auto value = take<std::uint64_t>(what);
  if (value > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    in_.fail(fmt::format("{} is {}, more than {}", what, value, std::numeric_limits<int>::max()));
  return static_cast<int>(value);
}

int MshNumbers::wide_count(const char* what, std::size_t bytes) {
  const int value = wide(what);
  if (value < 0 || static_cast<std::size_t>(value) > in_.bytes_left() / (binary_ ? bytes : 1))
    in_.fail(fmt::format("{} is {}, which the rest of the file cannot hold", what, value));
  return value;
}

double MshNumbers::number(const char* what) {
  if (!binary_) return in_.number(what);
  const auto value = take<double>(what);
  if (!std::isfinite(value)) in_.fail(fmt::format("{} is {}, not finite", what, value));
  return value;
}

}  // namespace polyslip::mesh
