// polyslip-mesher: the server that holds Gmsh and Netgen. It is started by polyslip with its
// control socket as descriptor 3, has the libraries loaded and never meshes itself: for each batch
// it forks a child, so that every batch starts from the same state. It ends with its parent.

#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "mesh/mesher_protocol.hpp"
#include "mesh/worker/batch.hpp"
#include "mesh/worker/fault_injection.hpp"
#include "mesh/worker/mesher.hpp"

namespace {

using namespace polyslip::mesh;
using protocol::Control;
using protocol::ControlMessage;

constexpr int control = 3;

struct Child {
  pid_t pid = 0;  // 0: none
  std::uint32_t token = 0;
};
using Children = std::array<Child, protocol::max_children>;

void kill_all(Children& children) {
  for (auto& child : children)
    if (child.pid > 0) kill(child.pid, SIGKILL);
  for (auto& child : children)
    if (child.pid > 0) waitpid(child.pid, nullptr, 0);
}

[[noreturn]] void end(Children& children) {
  kill_all(children);
  _exit(0);
}

void say(Children& children, const ControlMessage& message) {
  if (send(control, &message, sizeof message, MSG_NOSIGNAL) != sizeof message) end(children);
}

/// In the child: signals as in a new process, dead with its server.
[[noreturn]] void become_child(int socket, int signals, pid_t server) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != server) _exit(1);
  close(control);
  close(signals);
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGALRM, SIGPIPE, SIGCHLD})
    std::signal(s, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::srand(1);
  worker::serve_batch(socket);
}

/// One message from the main program; the attached socket, or -1.
bool receive(ControlMessage& message, int& socket) {
  iovec part{&message, sizeof message};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = room.data();
  header.msg_controllen = room.size();
  ssize_t n = 0;
  do n = recvmsg(control, &header, MSG_CMSG_CLOEXEC);
  while (n < 0 && errno == EINTR);
  socket = -1;
  if (n != sizeof message) return false;
  const cmsghdr* attached = CMSG_FIRSTHDR(&header);
  if (attached && attached->cmsg_type == SCM_RIGHTS)
    std::memcpy(&socket, CMSG_DATA(attached), sizeof socket);
  return true;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

void report_ended(Children& children, int signals) {
  signalfd_siginfo information{};
  if (read(signals, &information, sizeof information) < 0 && errno != EAGAIN) end(children);
  int status = 0;
  rusage usage{};
  for (pid_t pid = 0; (pid = wait4(-1, &status, WNOHANG, &usage)) > 0;)
    for (auto& child : children)
      if (child.pid == pid) {
        child.pid = 0;
        say(children, {Control::ended, child.token, status, 0,
                       seconds(usage.ru_utime) + seconds(usage.ru_stime)});
      }
}

/// Forks; a machine short of processes or memory gets six tries over three seconds, between which
/// ended children are reaped. -1 with errno if all fail.
pid_t fork_patiently(Children& children, int signals, int& refused) {
  constexpr int tries = 6;
  constexpr long first_pause = 100'000'000;  // ns
  for (int i = 0;; ++i) {
    pid_t pid = -1;
    errno = EAGAIN;
    if (refused > 0)
      --refused;
    else
      pid = fork();
    if (pid >= 0 || (errno != EAGAIN && errno != ENOMEM) || i + 1 == tries) return pid;
    const long pause = first_pause << i;
    const timespec time{pause / 1'000'000'000, pause % 1'000'000'000};
    nanosleep(&time, nullptr);
    report_ended(children, signals);
  }
}

void start_child(Children& children, std::uint32_t token, int socket, int signals, int& refused) {
  const pid_t server = getpid();
  pid_t pid = -1;
  int error = EAGAIN;
  const auto place = [&] {
    return std::find_if(children.begin(), children.end(), [](auto& c) { return c.pid == 0; });
  };
  if (place() != children.end()) {
    pid = fork_patiently(children, signals, refused);
    error = errno;
  }
  if (pid == 0) become_child(socket, signals, server);
  close(socket);
  if (pid < 0)
    say(children, {Control::not_forked, token, error, 0, 0});
  else
    *place() = {pid, token};
}

void obey(Children& children, int signals, int& refused) {
  ControlMessage message;
  int socket = -1;
  if (!receive(message, socket)) end(children);
  if (message.kind == Control::start && socket >= 0)
    start_child(children, message.token, socket, signals, refused);
  else if (message.kind == Control::kill)
    for (auto& child : children)
      if (child.pid > 0 && child.token == message.token) kill(child.pid, SIGKILL);
}

}  // namespace

int main(int argc, char**) {
  int type = 0;
  socklen_t size = sizeof type;
  if (argc != 1 || getsockopt(control, SOL_SOCKET, SO_TYPE, &type, &size) != 0 ||
      type != SOCK_SEQPACKET) {
    std::fputs("polyslip-mesher holds the meshers of polyslip and is started by it\n", stderr);
    return 2;
  }
  worker::initialise_gmsh();
  worker::initialise_netgen();
  sigset_t ended;
  sigemptyset(&ended);
  sigaddset(&ended, SIGCHLD);
  std::signal(SIGCHLD, SIG_DFL);
  sigprocmask(SIG_BLOCK, &ended, nullptr);
  const int signals = signalfd(-1, &ended, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals < 0) return 1;
  static Children children;
  int refused = worker::FaultInjection::from_environment().refused_forks();
  for (;;) {
    std::array<pollfd, 2> sources{{{control, POLLIN, 0}, {signals, POLLIN, 0}}};
    if (poll(sources.data(), sources.size(), -1) < 0 && errno != EINTR) end(children);
    if (sources[1].revents != 0) report_ended(children, signals);
    if (sources[0].revents != 0) obey(children, signals, refused);
  }
}
