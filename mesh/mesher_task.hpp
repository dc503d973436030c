#pragma once
// One batch of grains or faces with one mesher, as the main program sees it.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesher_protocol.hpp"
#include "mesh/mesher_spawner.hpp"

namespace polyslip::mesh {

/// What a task does, item by item.
struct MesherWork {
  std::string mesher;
  double timeout = 0;     ///< CPU seconds an item
  std::size_t count = 0;  ///< of items
  std::function<protocol::Bytes(std::size_t first)>
      encode;                                         ///< the message for items [first, count)
  std::function<std::string(std::size_t item)> name;  ///< for messages: "grain 7"
  /// Decodes, validates and takes an answer; why it is not one, else nothing.
  std::function<std::string(std::size_t item, const protocol::Bytes& answer)> take;
  std::function<void(std::size_t item, const std::string& why)> take_fault;
};

/// Walks through its items, child by child: a child that ends early, sends what is no message or a
/// mesh that is not valid costs the item that it was at; a new child goes on with the item after
/// it. What a child sends after such a fault is not read, so that nothing depends on how far it
/// came.
class MesherTask {
 public:
  explicit MesherTask(MesherWork work);

  /// Starts a child for the items that are left.
  void start(Spawner& spawner, std::uint32_t token);
  /// Sends and receives what the socket takes and has.
  void work(Spawner& spawner);
  /// The child's wait status.
  void child_ended(Spawner& spawner, int status);

  std::uint32_t token() const { return token_; }
  int socket() const { return socket_.get(); }  ///< -1: nothing to wait for but the child's end
  bool wants_to_send() const { return sent_ < output_.size(); }
  bool running() const { return running_; }
  bool finished() const { return !running_ && next_ == work_.count; }

 private:
  void send_some();
  ssize_t receive_some();
  void read_messages(Spawner& spawner);
  void obey(const protocol::Header& header, const protocol::Bytes& payload);
  void fail(const std::string& why);
  void abandon(Spawner& spawner);
  std::string describe(int status) const;

  MesherWork work_;
  std::size_t next_ = 0, base_ = 0;  // base_: the first item of the present child
  Descriptor socket_;
  std::uint32_t token_ = 0;
  bool running_ = false;
  bool failed_ = false;  // the present child is not listened to any more
  protocol::Bytes output_, input_;
  std::size_t sent_ = 0;
};

}  // namespace polyslip::mesh
