#pragma once
// Runs the program as a user does, kills it as a user may, and looks at what it leaves behind.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace polyslip::tests {

/// The content of a file; empty if it is not there.
std::string slurp(const std::filesystem::path& path);

/// Tries every half millisecond until the condition holds; false after so many seconds.
bool eventually(double seconds, const std::function<bool()>& condition);

/// A folder of its own for a test, removed at the end.
class Sandbox {
 public:
  Sandbox();
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Writes a file, and the folders it is in.
  void write(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal if killed by one
  std::string out, err;
};

/// The command line of build/polyslip with these arguments, under mpirun unless `ranks` is 0.
std::vector<std::string> on_ranks(int ranks, std::vector<std::string> polyslip_arguments);

/// A program that runs beside the test; killed at the end of its scope if it still does.
class Program {
 public:
  /// Starts `arguments[0]` with the rest in `folder`.
  Program(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  bool ended();
  Outcome wait();
  /// Every process that comes from this one, near or far, and lives: number and name. (They are
  /// known by a variable of their environment.)
  std::vector<std::pair<int, std::string>> processes() const;
  /// SIGKILL to those of them with one of these names, or to all if none is given.
  void kill(const std::set<std::string>& names);

 private:
  static constexpr const char* mark_name = "POLYSLIP_TEST_PROGRAM";
  Sandbox output_;
  std::string mark_;
  pid_t child_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

/// Runs `arguments[0]` with the rest in `folder`, and waits for it.
Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// build/polyslip with these arguments.
Outcome run_polyslip(std::vector<std::string> arguments, const std::filesystem::path& folder);

/// Every file and folder below `folder`, by relative path, with its time of change and content
/// ("folder" for folders).
std::map<std::string, std::string> tree(const std::filesystem::path& folder);

/// Runs polyslip in the sandbox and expects exit code 2, nothing on the standard output, exactly
/// this one line on the standard error, and a disk as it was.
void expect_rejection(const Sandbox& sandbox, const std::vector<std::string>& arguments,
                      const std::string& line);

}  // namespace polyslip::tests
