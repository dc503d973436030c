#include "core/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/error.hpp"
#include "core/handle.hpp"

namespace polyslip::core {

namespace {

constexpr std::size_t buffer_size = 1 << 20;
constexpr std::size_t longest_number = 32;

using Descriptor = Handle<int, ::close, -1>;

/// "results/a.h5: cannot write: No space left on device"
InputError system_error(const std::string& path, const char* what, int code) {
  return InputError(path + ": " + what + ": " + std::strerror(code));
}

[[noreturn]] void drop_part(const std::string& path, const char* what, int code) {
  ::unlink(part_path(path).c_str());
  throw system_error(path, what, code);
}

void write_all(int file, const std::string& path, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(file, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) drop_part(path, "cannot write", n < 0 ? errno : ENOSPC);
    content.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Makes a rename inside `path`'s folder durable. Some file systems refuse to sync folders; the
/// file has its name by then, so that is no error.
void sync_folder_of(const std::string& path) {
  auto folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor) ::fsync(descriptor.get());
}

}  // namespace

std::string part_path(const std::string& path) { return path + ".part"; }

void publish_part(const std::string& path) {
  const std::string part = part_path(path);
  Descriptor file(::open(part.c_str(), O_RDWR | O_CLOEXEC));
  if (!file) throw system_error(part, "cannot open", errno);
  if (::fsync(file.get()) != 0) drop_part(path, "cannot write", errno);
  if (file.close() != 0) drop_part(path, "cannot write", errno);
  if (::rename(part.c_str(), path.c_str()) != 0) drop_part(path, "cannot rename", errno);
  sync_folder_of(path);
}

void write_file(const std::string& path, std::string_view content) {
  const std::string part = part_path(path);
  Descriptor file(::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file) throw system_error(path, "cannot write", errno);
  write_all(file.get(), path, content);
  if (file.close() != 0) drop_part(path, "cannot write", errno);
  publish_part(path);
}

void require_room(const std::string& path, std::uint64_t bytes) {
  const std::string part = part_path(path);
  Descriptor file(::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file) throw system_error(path, "cannot write", errno);
  const int error = ::posix_fallocate(file.get(), 0, static_cast<off_t>(bytes));
  if (error != 0) drop_part(path, "cannot write", error);
  if (::ftruncate(file.get(), 0) != 0) drop_part(path, "cannot write", errno);
}

FileWriter::FileWriter(std::string path) : path_(std::move(path)) {
  file_ = ::open(part_path(path_).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) throw system_error(path_, "cannot write", errno);
  buffer_.reserve(buffer_size + longest_number);
}

FileWriter::~FileWriter() {
  if (file_ < 0) return;
  ::close(file_);
  ::unlink(part_path(path_).c_str());
}

void FileWriter::put(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) flush();
}

void FileWriter::put(long number) {
  std::array<char, longest_number> digits;
  const auto end = std::to_chars(digits.begin(), digits.end(), number).ptr;
  put(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

void FileWriter::put(double number) {
  std::array<char, longest_number> digits;
  const auto end = std::to_chars(digits.begin(), digits.end(), number).ptr;
  put(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

void FileWriter::flush() {
  write_all(file_, path_, buffer_);
  buffer_.clear();
}

void FileWriter::finish() {
  flush();
  const int file = file_;
  file_ = -1;
  if (::close(file) != 0) drop_part(path_, "cannot write", errno);
  publish_part(path_);
}

std::string read_text(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file && errno == ENOENT) throw InputError(path + ": no such file");
  if (!file) throw system_error(path, "cannot read", errno);
  std::string text;
  char buffer[65536];
  while (true) {
    const ssize_t n = ::read(file.get(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw system_error(path, "cannot read", errno);
    if (n == 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError(path + ": cannot make this folder: " + error.message());
}

void require_writable_folder(const std::string& path) {
  std::string name = (std::filesystem::path(path) / ".polyslip-XXXXXX").string();
  const Descriptor file(::mkstemp(name.data()));
  if (!file) throw InputError(path + ": cannot write in this folder: " + std::strerror(errno));
  ::unlink(name.c_str());
}

}  // namespace polyslip::core
