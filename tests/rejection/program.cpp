#include "rejection/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace polyslip::tests {

namespace fs = std::filesystem;

namespace {

std::string slurp(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void redirect(const fs::path& path, int descriptor) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(126);
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const fs::path& folder) {
  const Sandbox output;
  const fs::path out = output.path() / "out", err = output.path() / "err";
  std::vector<char*> argv;
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("waitpid failed");
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, slurp(out), slurp(err)};
}

Outcome run_polyslip(std::vector<std::string> arguments, const fs::path& folder) {
  arguments.insert(arguments.begin(), POLYSLIP_BINARY_DIR "/polyslip");
  return run_program(arguments, folder);
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
