#pragma once
// One owning handle for what C libraries hand out: no copy, move by exchange.

#include <type_traits>
#include <utility>

namespace polyslip::core {

/// Owns a resource `T` (an id or a pointer) that `close_function` gives back. The function takes a
/// T (HDF5: `Handle<hid_t, H5Fclose, hid_t{-1}>`) or a T* (PETSc: `Handle<Vec, VecDestroy>`).
/// Constructing adopts: the handle closes what it is given. `get` lends it to a call.
template <class T, auto close_function, T none = T{}>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T adopted) : value_(adopted) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&& other) noexcept : value_(std::exchange(other.value_, none)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Handle() { close(); }

  T get() const { return value_; }
  explicit operator bool() const { return value_ != none; }
  /// For calls that create by pointer: gives back what it held, then lends its address.
  T* receive() {
    close();
    return &value_;
  }
  /// The caller owns it from here.
  T release() { return std::exchange(value_, none); }
  /// Gives the resource back now; what the library returned (0, or what success looks like, if
  /// there was nothing), for callers that check it.
  auto close() {
    T value = std::exchange(value_, none);
    if constexpr (std::is_invocable_v<decltype(close_function), T>) {
      using Status = decltype(close_function(value));
      if constexpr (std::is_void_v<Status>) {
        if (value != none) close_function(value);
      } else {
        return value != none ? close_function(value) : Status{};
      }
    } else {
      using Status = decltype(close_function(&value));
      return value != none ? close_function(&value) : Status{};
    }
  }

 private:
  T value_ = none;
};

}  // namespace polyslip::core
