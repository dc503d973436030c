#include "mesh/text_scanner.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::mesh {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// A stream of zlib's that is closed when it goes.
class Inflater {
 public:
  explicit Inflater(std::string& packed) {
    stream_.next_in = reinterpret_cast<Bytef*>(packed.data());
    good_ = packed.size() <= std::numeric_limits<uInt>::max() &&
            inflateInit2(&stream_, 16 + MAX_WBITS) == Z_OK;
    if (good_) stream_.avail_in = static_cast<uInt>(packed.size());
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() {
    if (good_) inflateEnd(&stream_);
  }

  /// Unpacks all members of the file; false if it is damaged or ends early.
  bool unpack(std::string& text) {
    if (!good_) return false;
    std::array<char, 1 << 16> buffer{};
    for (;;) {
      stream_.next_out = reinterpret_cast<Bytef*>(buffer.data());
      stream_.avail_out = static_cast<uInt>(buffer.size());
      const int state = inflate(&stream_, Z_NO_FLUSH);
      if (state != Z_OK && state != Z_STREAM_END) return false;
      text.append(buffer.data(), buffer.size() - stream_.avail_out);
      if (state != Z_STREAM_END) continue;
      if (stream_.avail_in == 0) return true;
      if (inflateReset(&stream_) != Z_OK) return false;
    }
  }

 private:
  z_stream stream_{};
  bool good_ = false;
};

}  // namespace

std::string read_maybe_compressed(const std::string& path) {
  std::string content = core::read_text(path);
  if (!content.starts_with("\x1f\x8b")) return content;
  std::string text;
  if (!Inflater(content).unpack(text))
    throw core::InputError(path + ": the compressed file is damaged or ends early; copy it again");
  return text;
}

TextScanner::TextScanner(std::string path, std::string text)
    : path_(std::move(path)), text_(std::move(text)) {}

void TextScanner::fail(const std::string& what) const {
  if (binary_) throw core::InputError(fmt::format("{}: at byte {}: {}", path_, at_, what));
  throw core::InputError(fmt::format("{}:{}: {}", path_, line_, what));
}

std::string_view TextScanner::peek() {
  for (; at_ < text_.size() && is_space(text_[at_]); ++at_)
    if (text_[at_] == '\n') ++line_;
  std::size_t end = at_;
  while (end < text_.size() && !is_space(text_[end])) ++end;
  return std::string_view(text_).substr(at_, end - at_);
}

std::string_view TextScanner::word(const char* what) {
  const std::string_view found = peek();
  if (found.empty()) fail(fmt::format("the file ends where {} should be", what));
  at_ += found.size();
  return found;
}

int TextScanner::integer(const char* what) {
  const std::string_view found = word(what);
  int value = 0;
  const auto [stop, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error != std::errc{} || stop != found.data() + found.size())
    fail(fmt::format("'{}' should be {}, an integer", found, what));
  return value;
}

double TextScanner::number(const char* what) {
  const std::string_view found = word(what);
  double value = 0;
  const char* begin = found.data() + (found[0] == '+' ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, found.data() + found.size(), value);
  if (error != std::errc{} || stop != found.data() + found.size())
    fail(fmt::format("'{}' should be {}, a number", found, what));
  if (!std::isfinite(value)) fail(fmt::format("{} is {}, not finite", what, found));
  return value;
}

int TextScanner::count(const char* what) {
  const int value = integer(what);
  if (value < 0 || static_cast<std::size_t>(value) > text_.size() - at_)
    fail(fmt::format("{} is {}, which the rest of the file cannot hold", what, value));
  return value;
}

void TextScanner::expect(std::string_view expected) {
  const std::string_view found = peek();
  if (found != expected)
    fail(fmt::format("{} where {} should be",
                     found.empty() ? "the file ends" : fmt::format("'{}'", found), expected));
  at_ += found.size();
}

std::string_view TextScanner::bytes(std::size_t count, const char* what) {
  binary_ = true;
  if (count > text_.size() - at_) fail(fmt::format("the file ends where {} should be", what));
  at_ += count;
  return std::string_view(text_).substr(at_ - count, count);
}

void TextScanner::skip_past(std::string_view marker) {
  const std::size_t found = text_.find(marker, at_);
  if (found == std::string::npos) fail(fmt::format("the file ends where {} should be", marker));
  for (; at_ < found + marker.size(); ++at_)
    if (text_[at_] == '\n') ++line_;
}

std::string_view TextScanner::rest_of_line() {
  std::size_t end = at_;
  while (end < text_.size() && text_[end] != '\n') ++end;
  const std::string_view rest = std::string_view(text_).substr(at_, end - at_);
  at_ = end;
  return rest;
}

}  // namespace polyslip::mesh
