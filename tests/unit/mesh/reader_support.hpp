#pragma once
// Files for the tests of readers, and what a reader says of a wrong one.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::mesh {

/// A file that goes with the test.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path_(testing::TempDir() + "polyslip_" + std::to_string(::getpid()) + "_" + name) {
    core::write_file(path_, text);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The message of the InputError that `read(path)` throws for a text, without the path; "" if none.
template <class Read>
std::string fault_of(const std::string& name, const std::string& text, Read&& read) {
  const TemporaryFile file(name, text);
  try {
    read(file.path());
  } catch (const core::InputError& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.rfind(file.path() + ":", 0), 0U) << message;
    return message.substr(file.path().size() + 1);
  }
  return "";
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

}  // namespace polyslip::mesh
