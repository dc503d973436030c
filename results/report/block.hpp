#pragma once
// Binary data of the page.

#include <string>

#include "results/report/encode.hpp"

namespace polyslip::results::report {

struct Block {
  std::string name, text;  ///< base64 of a gzip stream
};

inline Block make_block(std::string name, std::string_view bytes) {
  return {std::move(name), base64(gzip(bytes))};
}

}  // namespace polyslip::results::report
