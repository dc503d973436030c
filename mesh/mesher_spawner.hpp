#pragma once
// The process that stands between the main program and the meshers: forked while the main program
// is small, it waits; at the first word it becomes polyslip-mesher (mesh/worker/main.cpp).

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "mesh/mesher_protocol.hpp"

namespace polyslip::mesh {

/// File descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }
  void reset();

 private:
  int fd_ = -1;
};

class Spawner {
 public:
  /// Forks. The process is killed with this one, whatever ends it. `executable` is taken as seen
  /// from the current folder.
  explicit Spawner(const std::string& executable);
  ~Spawner();
  Spawner(const Spawner&) = delete;
  Spawner& operator=(const Spawner&) = delete;

  /// Asks for a child that serves the socket whose other end is returned (non-blocking).
  Descriptor start_child(std::uint32_t token);
  void kill_child(std::uint32_t token);
  /// A child's end, or that it could not be forked, if one was reported. Throws InternalError if
  /// the server is gone, InputError if it could not be executed.
  std::optional<protocol::ControlMessage> next_message();
  int control() const { return control_.get(); }

 private:
  void send(const protocol::ControlMessage& message, int attached);
  [[noreturn]] void throw_gone();

  std::string executable_;
  Descriptor control_;
  pid_t pid_ = -1;
};

}  // namespace polyslip::mesh
