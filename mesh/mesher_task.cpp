#include "mesh/mesher_task.hpp"

#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace polyslip::mesh {

MesherTask::MesherTask(MesherWork work) : work_(std::move(work)) {}

void MesherTask::start(Spawner& spawner, std::uint32_t token) {
  base_ = next_;
  output_ = work_.encode(next_);
  input_.clear();
  sent_ = 0;
  token_ = token;
  failed_ = false;
  socket_ = spawner.start_child(token);
  running_ = true;
}

void MesherTask::work(Spawner& spawner) {
  send_some();
  const bool open = receive_some() != 0;
  read_messages(spawner);
  if (!open || failed_) socket_.reset();
}

void MesherTask::child_ended(Spawner& spawner, int status) {
  if (socket_.get() >= 0) {
    while (receive_some() > 0) {
    }
    read_messages(spawner);
    socket_.reset();
  }
  running_ = false;
  if (!failed_ && next_ < work_.count) fail(describe(status));
}

void MesherTask::send_some() {
  while (wants_to_send()) {
    const ssize_t n =
        ::send(socket_.get(), output_.data() + sent_, output_.size() - sent_, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno != EAGAIN) sent_ = output_.size();  // the child is gone: its end is reported
    if (n <= 0) return;
    sent_ += static_cast<std::size_t>(n);
  }
}

/// Bytes received; 0: there will be no more; -1: none now.
ssize_t MesherTask::receive_some() {
  std::array<char, 1 << 16> buffer;
  ssize_t n = 0;
  do n = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
  while (n < 0 && errno == EINTR);
  if (n < 0) return errno == EAGAIN ? -1 : 0;
  input_.insert(input_.end(), buffer.begin(), buffer.begin() + n);
  return n;
}

void MesherTask::read_messages(Spawner& spawner) {
  std::size_t position = 0;
  try {
    while (!failed_ && input_.size() - position >= sizeof(protocol::Header)) {
      const protocol::Header header = protocol::decode_header(input_.data() + position);
      const std::size_t begin = position + sizeof header;
      if (input_.size() - begin < header.length) break;
      position = begin + header.length;
      obey(header, protocol::Bytes(input_.begin() + static_cast<std::ptrdiff_t>(begin),
                                   input_.begin() + static_cast<std::ptrdiff_t>(position)));
    }
  } catch (const protocol::ProtocolError& error) {
    fail(fmt::format("garbage for an answer ({})", error.what()));
  }
  input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(position));
  if (failed_) abandon(spawner);
}

void MesherTask::obey(const protocol::Header& header, const protocol::Bytes& payload) {
  if (header.index != next_ - base_ || next_ >= work_.count)
    throw protocol::ProtocolError("another item than the one at work");
  if (header.kind == protocol::Kind::begin) return;
  if (header.kind == protocol::Kind::failed) {
    fail(protocol::decode_failed(payload));
    return;
  }
  if (header.kind != protocol::Kind::mesh) throw protocol::ProtocolError("an unknown message");
  const std::string fault = work_.take(next_, payload);
  if (fault.empty())
    ++next_;
  else
    fail(fault);
}

void MesherTask::fail(const std::string& why) {
  work_.take_fault(next_, fmt::format("mesher '{}', {}: {}", work_.mesher, work_.name(next_), why));
  ++next_;
  failed_ = true;
}

void MesherTask::abandon(Spawner& spawner) {
  input_.clear();
  if (running_) spawner.kill_child(token_);
}

std::string MesherTask::describe(int status) const {
  if (!WIFSIGNALED(status)) return fmt::format("ended with code {}", WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) return fmt::format("killed after {:g} s of CPU", work_.timeout);
  if (signal == SIGALRM) return "killed: it neither computed nor ended";
  return fmt::format("killed by signal {} ({})", signal, strsignal(signal));
}

}  // namespace polyslip::mesh
