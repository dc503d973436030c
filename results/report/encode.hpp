#pragma once
// Bytes as a page can carry them.

#include <string>
#include <string_view>

namespace polyslip::results::report {

/// A gzip stream (RFC 1952). The same bytes give the same stream. InternalError if zlib fails.
std::string gzip(std::string_view bytes);

/// RFC 4648, with padding, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace polyslip::results::report
