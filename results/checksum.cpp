#include "results/checksum.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <fstream>
#include <vector>

#include "core/error.hpp"
#include "results/schema.hpp"

namespace polyslip::results {
namespace {

[[noreturn]] void damaged(const std::string& path, const std::string& how) {
  throw core::InputError(fmt::format(
      "{}: is damaged ({}); restart from a checkpoint before it or run anew", path, how));
}

/// The header of a body of this length and CRC-32.
std::string header_of(std::uint64_t length, std::uint32_t crc, int version) {
  std::string text =
      fmt::format("{} {}\nbytes {}\ncrc32 {:08x}\n", state_file_type, version, length, crc);
  text.resize(header_size, '\0');
  return text;
}

struct Body {
  std::uint64_t length = 0;
  std::uint32_t crc = 0;
};

/// Reads on to the end of the stream.
Body measure_body(std::istream& in) {
  Body body;
  std::vector<char> buffer(1 << 20);
  uLong crc = crc32(0, nullptr, 0);
  while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), in.gcount() > 0) {
    crc = crc32(crc, reinterpret_cast<const Bytef*>(buffer.data()), static_cast<uInt>(in.gcount()));
    body.length += static_cast<std::uint64_t>(in.gcount());
  }
  body.crc = static_cast<std::uint32_t>(crc);
  return body;
}

}  // namespace

void seal(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(header_size);
  const Body body = measure_body(file);
  const bool read_all = file.eof() && !file.bad();
  file.clear();
  file.seekp(0);
  const std::string header = header_of(body.length, body.crc, state_file_version);
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
  file.close();
  if (!read_all || !file) throw core::InputError(path + ": cannot write the checksum");
}

void verify_seal(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw core::InputError(path + ": no such file, or not readable");
  std::string header(header_size, '\0');
  in.read(header.data(), header_size);
  if (in.gcount() < static_cast<std::streamsize>(header_size))
    damaged(path, fmt::format("only {} bytes long", in.gcount()));
  const Body body = measure_body(in);
  if (header == header_of(body.length, body.crc, state_file_version)) return;
  if (!header.starts_with(state_file_type + " ")) damaged(path, "not a polyslip-state file");
  int version = 0;
  std::uint64_t length = 0;
  unsigned crc = 0;
  if (std::sscanf(header.c_str() + state_file_type.size(), " %d bytes %lu crc32 %x", &version,
                  &length, &crc) != 3)
    damaged(path, "header is garbled");
  if (header == header_of(body.length, body.crc, version))
    throw core::InputError(fmt::format(
        "{}: is of version {} of the state file, this program reads version {}; use the "
        "program that wrote it",
        path, version, state_file_version));
  if (length != body.length)
    damaged(path, fmt::format("{} bytes after the header instead of {}", body.length, length));
  damaged(path, "checksum does not match");
}

}  // namespace polyslip::results
