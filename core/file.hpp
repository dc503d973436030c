#pragma once
// Files that are either whole or not there.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace polyslip::core {

/// Where a file is built before it gets its name: `path` + ".part", beside it.
std::string part_path(const std::string& path);

/// Makes the finished `part_path(path)` durable and gives it its name: fsync, rename, fsync of the
/// folder. For files that a library writes (HDF5). Throws InputError with path and reason; the part
/// is then gone and what stood at `path` before still stands.
void publish_part(const std::string& path);

/// Writes `content` to `path`, atomically, as above. A full disk is an InputError.
void write_file(const std::string& path, std::string_view content);

/// InputError unless so many bytes can be written beside `path` now; tried by allocating them in
/// its part file, which is left empty. For libraries that do not survive a full disk.
void require_room(const std::string& path, std::uint64_t bytes);

/// A file written piece by piece, for what is too large to be held as one text. It is built at
/// part_path(path) and gets its name by `finish`; without that, or after an error, nothing is left
/// of it. Errors as those of write_file.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void put(std::string_view text);
  void put(char c) { put(std::string_view(&c, 1)); }
  void put(long number);
  void put(int number) { put(static_cast<long>(number)); }
  void put(std::size_t number) { put(static_cast<long>(number)); }
  /// The shortest text that reads back as the same number.
  void put(double number);
  void finish();

 private:
  void flush();

  std::string path_, buffer_;
  int file_ = -1;
};

/// The whole file. InputError "<path>: no such file" or with the system's reason.
std::string read_text(const std::string& path);

/// Makes a folder and its parents. InputError if that is not possible.
void make_folder(const std::string& path);

/// InputError unless files can be made in `path` (tried, not guessed).
void require_writable_folder(const std::string& path);

}  // namespace polyslip::core
