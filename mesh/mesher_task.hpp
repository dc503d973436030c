#pragma once
// One batch of grains with one mesher, as the main program sees it.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesher_protocol.hpp"
#include "mesh/mesher_spawner.hpp"

namespace polyslip::mesh {

/// Walks through the requests [first, last), child by child: a child that ends early, sends what is
/// no message or a mesh that is not valid costs the grain that it was at; a new child goes on with
/// the grain after it. What a child sends after such a fault is not read, so that nothing depends
/// on how far it came.
class MesherTask {
 public:
  struct Sink {
    std::function<void(std::size_t request, VolumeMesh&& mesh)> take_mesh;  ///< valid ones
    std::function<void(std::size_t request, const std::string& why)> take_fault;
  };

  MesherTask(const std::vector<GrainRequest>& requests, std::size_t first, std::size_t last,
             std::string mesher, double element_size, double timeout, Sink sink);

  /// Starts a child for the grains that are left.
  void start(Spawner& spawner, std::uint32_t token);
  /// Sends and receives what the socket takes and has.
  void work(Spawner& spawner);
  /// The child's wait status.
  void child_ended(Spawner& spawner, int status);

  std::uint32_t token() const { return token_; }
  int socket() const { return socket_.get(); }  ///< -1: nothing to wait for but the child's end
  bool wants_to_send() const { return sent_ < output_.size(); }
  bool running() const { return running_; }
  bool finished() const { return !running_ && next_ == last_; }

 private:
  void send_some();
  ssize_t receive_some();
  void read_messages(Spawner& spawner);
  void obey(const protocol::Header& header, const protocol::Bytes& payload);
  void fail(const std::string& why);
  void abandon(Spawner& spawner);
  std::string describe(int status) const;

  const std::vector<GrainRequest>& requests_;
  std::size_t last_, next_, base_;  // base_: the first request of the present child
  std::string mesher_;
  double element_size_, timeout_;
  Sink sink_;
  Descriptor socket_;
  std::uint32_t token_ = 0;
  bool running_ = false;
  bool failed_ = false;  // the present child is not listened to any more
  protocol::Bytes output_, input_;
  std::size_t sent_ = 0;
};

}  // namespace polyslip::mesh
