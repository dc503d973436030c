#include "support/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace polyslip::tests {

namespace fs = std::filesystem;

namespace {

void redirect(const fs::path& path, int descriptor) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(126);
}

}  // namespace

std::string slurp(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

bool eventually(double seconds, const std::function<bool()>& condition) {
  using clock = std::chrono::steady_clock;
  const auto end = clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (clock::now() > end) return false;
    ::usleep(500);
  }
  return true;
}

std::vector<std::string> on_ranks(int ranks, std::vector<std::string> polyslip_arguments) {
  std::vector<std::string> all;
  if (ranks > 0)
    all = {POLYSLIP_MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", std::to_string(ranks)};
  all.push_back(POLYSLIP_BINARY_DIR "/polyslip");
  all.insert(all.end(), polyslip_arguments.begin(), polyslip_arguments.end());
  return all;
}

Program::Program(const std::vector<std::string>& arguments, const fs::path& folder) {
  static int count = 0;
  mark_ = std::string(mark_name) + "=" + std::to_string(::getpid()) + "." + std::to_string(++count);
  const fs::path out = output_.path() / "out", err = output_.path() / "err";
  std::vector<char*> argv;
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  child_ = ::fork();
  if (child_ < 0) throw std::runtime_error("fork failed");
  if (child_ > 0) return;
  redirect(out, STDOUT_FILENO);
  redirect(err, STDERR_FILENO);
  ::putenv(mark_.data());
  if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
  ::_exit(127);
}

Program::~Program() {
  if (!ended()) {
    kill({});
    ::waitpid(child_, &status_, 0);
  }
}

bool Program::ended() {
  if (!ended_) ended_ = ::waitpid(child_, &status_, WNOHANG) == child_;
  return ended_;
}

Outcome Program::wait() {
  if (!ended_ && ::waitpid(child_, &status_, 0) != child_)
    throw std::runtime_error("waitpid failed");
  ended_ = true;
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  return {code, slurp(output_.path() / "out"), slurp(output_.path() / "err")};
}

std::vector<std::pair<int, std::string>> Program::processes() const {
  std::vector<std::pair<int, std::string>> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const int pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 0) continue;
    const std::string variables = '\0' + slurp(entry.path() / "environ");
    if (variables.find('\0' + mark_ + '\0') == std::string::npos) continue;
    std::string name = slurp(entry.path() / "comm");
    found.emplace_back(pid, name.substr(0, name.find('\n')));
  }
  return found;
}

void Program::kill(const std::set<std::string>& names) {
  for (const auto& [pid, name] : processes())
    if (names.empty() || names.count(name) > 0) ::kill(pid, SIGKILL);
}

Outcome run_program(const std::vector<std::string>& arguments, const fs::path& folder) {
  return Program(arguments, folder).wait();
}

Outcome run_polyslip(std::vector<std::string> arguments, const fs::path& folder) {
  return run_program(on_ranks(0, std::move(arguments)), folder);
}

std::map<std::string, std::string> tree(const fs::path& folder) {
  std::map<std::string, std::string> entries;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    struct stat info {};
    ::lstat(entry.path().c_str(), &info);
    const std::string time =
        std::to_string(info.st_mtim.tv_sec) + "." + std::to_string(info.st_mtim.tv_nsec);
    entries[fs::relative(entry.path(), folder).string()] =
        entry.is_regular_file() ? time + "\n" + slurp(entry.path()) : "folder";
  }
  return entries;
}

Sandbox::Sandbox() {
  std::string name = (fs::temp_directory_path() / "polyslip-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  path_ = name;
}

Sandbox::~Sandbox() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Sandbox::write(const std::string& name, const std::string& content) const {
  fs::create_directories((path_ / name).parent_path());
  std::ofstream(path_ / name, std::ios::binary) << content;
}

void expect_rejection(const Sandbox& sandbox, const std::vector<std::string>& arguments,
                      const std::string& line) {
  const auto before = tree(sandbox.path());
  const Outcome outcome = run_polyslip(arguments, sandbox.path());
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.err, line + "\n");
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(tree(sandbox.path()), before);
}

}  // namespace polyslip::tests
