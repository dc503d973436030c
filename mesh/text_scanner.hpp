#pragma once
// Reading a text file word by word, with the line in every message.

#include <cstddef>
#include <string>
#include <string_view>

namespace polyslip::mesh {

/// The whole file; one compressed by gzip (told by its first bytes) is unpacked. InputError if it
/// cannot be read or its packing is damaged.
std::string read_maybe_compressed(const std::string& path);

/// Words are what white space separates. Every failure is an InputError "<path>:<line>: <what>".
class TextScanner {
 public:
  /// `path` is for messages.
  TextScanner(std::string path, std::string text);

  /// The next word without taking it; empty at the end of the file.
  std::string_view peek();
  /// Takes a word; `what` says in the message what the file should have had there.
  std::string_view word(const char* what);
  int integer(const char* what);
  /// A finite number.
  double number(const char* what);
  /// A count: an integer that the rest of the file can hold.
  int count(const char* what);
  /// Takes one word, which must be `expected`.
  void expect(std::string_view expected);
  /// The rest of the line, which may be empty.
  std::string_view rest_of_line();
  /// The next `count` bytes, whatever they are. From the first such call on, messages tell the byte
  /// ("<path>: at byte <n>: <what>") in place of the line, which has lost its meaning.
  std::string_view bytes(std::size_t count, const char* what);
  /// Goes behind the next place where `marker` stands.
  void skip_past(std::string_view marker);
  std::size_t bytes_left() const { return text_.size() - at_; }

  [[noreturn]] void fail(const std::string& what) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool binary_ = false;
};

}  // namespace polyslip::mesh
