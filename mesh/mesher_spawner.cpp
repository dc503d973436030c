#include "mesh/mesher_spawner.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using protocol::Control;
using protocol::ControlMessage;

constexpr int server_control = 3;  // the server's descriptor of its control socket

/// Environment of the meshers: one thread, plain numbers, and nothing of mpirun's, so that no
/// library of theirs can take this process for a rank.
std::vector<std::string> server_environment() {
  constexpr std::array<std::string_view, 8> dropped{"OMPI_", "PMIX_", "PMI_", "PRTE_",
                                                    "ORTE_", "OPAL_", "OMP_", "LC_ALL="};
  std::vector<std::string> kept;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text(*entry);
    bool keep = true;
    for (const auto& prefix : dropped) keep = keep && !text.starts_with(prefix);
    if (keep) kept.emplace_back(text);
  }
  kept.emplace_back("OMP_NUM_THREADS=1");
  kept.emplace_back("LC_ALL=C");
  return kept;
}

void move_to_null(int fd, int flags) {
  const int null = open("/dev/null", flags);
  if (null < 0) return;
  dup2(null, fd);
  if (null != fd) close(null);
}

/// The spawner's life. Nothing of the main program stays open in it: its pipes and sockets must
/// close when it ends.
[[noreturn]] void run_spawner(const std::string& executable, int control, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  prctl(PR_SET_NAME, "polyslip-spawn");
  std::signal(SIGINT, SIG_IGN);  // a terminal's ^C is for the main program to answer
  std::signal(SIGPIPE, SIG_IGN);
  if (control == server_control)
    fcntl(control, F_SETFD, 0);  // stays open in the server
  else
    dup2(control, server_control);
  close_range(server_control + 1, ~0U, 0);
  move_to_null(STDIN_FILENO, O_RDONLY);
  move_to_null(STDOUT_FILENO, O_WRONLY);
  move_to_null(STDERR_FILENO, O_WRONLY);

  char word = 0;
  ssize_t n = 0;
  do n = recv(server_control, &word, 1, MSG_PEEK);
  while (n < 0 && errno == EINTR);
  if (n <= 0) _exit(0);

  std::vector<std::string> environment = server_environment();
  std::vector<char*> variables;
  for (auto& entry : environment) variables.push_back(entry.data());
  variables.push_back(nullptr);
  std::string name = "polyslip-mesher";
  std::array<char*, 2> arguments{name.data(), nullptr};
  execve(executable.c_str(), arguments.data(), variables.data());
  ControlMessage message;
  message.kind = Control::not_executed;
  message.value = errno;
  send(server_control, &message, sizeof message, MSG_NOSIGNAL);
  // Read on, as an end with unread requests would reset the socket before this message is read.
  while (recv(server_control, &message, sizeof message, 0) > 0) {
  }
  _exit(127);
}

std::array<Descriptor, 2> make_sockets(int type) {
  std::array<int, 2> fds{};
  if (socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, fds.data()) != 0)
    throw core::InternalError(fmt::format("mesher pool: no socket pair: {}", strerror(errno)));
  return {Descriptor(fds[0]), Descriptor(fds[1])};
}

}  // namespace

void Descriptor::reset() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

Spawner::Spawner(const std::string& executable)
    : executable_(std::filesystem::absolute(executable).string()) {
  auto sockets = make_sockets(SOCK_SEQPACKET);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0)
    throw core::InternalError(fmt::format("mesher pool: cannot fork: {}", strerror(errno)));
  if (pid_ == 0) run_spawner(executable_, sockets[1].get(), parent);
  control_ = std::move(sockets[0]);
}

Spawner::~Spawner() {
  control_.reset();  // the server kills its children and ends
  if (pid_ <= 0) return;
  constexpr timespec pause{0, 10'000'000};
  for (int i = 0; i < 200; ++i) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) return;
    nanosleep(&pause, nullptr);
  }
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Spawner::throw_gone() {
  int status = 0;
  std::string how = "is gone";
  if (pid_ > 0 && waitpid(pid_, &status, 0) == pid_) {
    if (WIFSIGNALED(status))
      how = fmt::format("was killed by signal {} ({})", WTERMSIG(status),
                        strsignal(WTERMSIG(status)));
    else
      how = fmt::format("ended with code {}", WEXITSTATUS(status));
  }
  pid_ = -1;
  control_.reset();
  throw core::InternalError(fmt::format(
      "mesher pool: the mesher process {} {}; restart the run to go on", executable_, how));
}

void Spawner::send(const ControlMessage& message, int attached) {
  if (control_.get() < 0) throw_gone();
  ControlMessage copy = message;
  iovec part{&copy, sizeof copy};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (attached >= 0) {
    header.msg_control = room.data();
    header.msg_controllen = room.size();
    cmsghdr* rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(rights), &attached, sizeof attached);
  }
  ssize_t n = 0;
  do n = sendmsg(control_.get(), &header, MSG_NOSIGNAL);
  while (n < 0 && errno == EINTR);
  if (n != sizeof copy) {
    next_message();  // says why, if the server could not be executed
    throw_gone();
  }
}

Descriptor Spawner::start_child(std::uint32_t token) {
  auto sockets = make_sockets(SOCK_STREAM);
  ControlMessage message;
  message.kind = Control::start;
  message.token = token;
  send(message, sockets[1].get());
  fcntl(sockets[0].get(), F_SETFL, O_NONBLOCK);
  return std::move(sockets[0]);
}

void Spawner::kill_child(std::uint32_t token) {
  ControlMessage message;
  message.kind = Control::kill;
  message.token = token;
  send(message, -1);
}

std::optional<ControlMessage> Spawner::next_message() {
  if (control_.get() < 0) throw_gone();
  ControlMessage message;
  ssize_t n = 0;
  do n = recv(control_.get(), &message, sizeof message, MSG_DONTWAIT);
  while (n < 0 && errno == EINTR);
  if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return std::nullopt;
  if (n != sizeof message) throw_gone();
  if (message.kind == Control::not_executed) {
    control_.reset();
    throw core::InputError(
        fmt::format("cannot start the mesher program {}: {}; it is built and "
                    "installed next to polyslip",
                    executable_, strerror(message.value)));
  }
  return message;
}

}  // namespace polyslip::mesh
