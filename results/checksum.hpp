#pragma once
// The first 512 bytes of a state file: a text with type, version, length and CRC-32 of the bytes
// after it, filled up with zeros. HDF5 skips them as its user block. So each bit of the file is
// covered.

#include <cstdint>
#include <string>

namespace polyslip::results {

inline constexpr std::uint64_t header_size = 512;

/// Computes length and CRC-32 of what follows the header and writes the header. InputError if the
/// file cannot be read or written.
void seal(const std::string& path);

/// InputError, one line, unless the header is that of the bytes after it.
void verify_seal(const std::string& path);

}  // namespace polyslip::results
