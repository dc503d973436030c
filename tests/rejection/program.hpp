#pragma once
// Runs the program as a user does, and looks at what it leaves behind.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace polyslip::tests {

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal if killed by one
  std::string out, err;
};

/// Runs `arguments[0]` with the rest in `folder`, and waits for it.
Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// build/polyslip with these arguments.
Outcome run_polyslip(std::vector<std::string> arguments, const std::filesystem::path& folder);

/// Every file and folder below `folder`, by relative path, with its time of change and content
/// ("folder" for folders).
std::map<std::string, std::string> tree(const std::filesystem::path& folder);

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

/// Runs polyslip in the sandbox and expects exit code 2, nothing on the standard output, exactly
/// this one line on the standard error, and a disk as it was.
void expect_rejection(const Sandbox& sandbox, const std::vector<std::string>& arguments,
                      const std::string& line);

}  // namespace polyslip::tests
