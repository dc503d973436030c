#pragma once
// What every SVG file of ours shares.

#include <string>

namespace polyslip::results {

/// A text with the marks of XML replaced, to stand between tags.
std::string svg_escaped(const std::string& text);

}  // namespace polyslip::results
