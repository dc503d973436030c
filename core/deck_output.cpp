// What the declarations of a deck are written out as.

#include <fmt/format.h>

#include "core/deck.hpp"
#include "core/deck_impl.hpp"
#include "core/hash.hpp"

namespace polyslip::core {

namespace {

/// "[MPa] Elastic constant C11." for a comment.
std::string comment(const Declaration& d) {
  std::string text;
  if (!d.unit.empty() && d.unit != "1") text += "[" + d.unit + "] ";
  return text + d.help;
}

/// Plain text in Markdown, in a table too.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') result += '\\';
    result += c;
  }
  return result;
}

/// Text as code inside a cell.
std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

/// "[section]", or "[[section.list]]" of one of a list.
std::string heading(const std::string& section) {
  const auto space = section.find(' ');
  return space == std::string::npos ? "[" + section + "]" : "[[" + section.substr(0, space) + "]]";
}

std::string fallback_cell(const Declaration& d) {
  if (!d.fallback.empty()) return code(d.fallback);
  return d.optional ? "none" : "required";
}

}  // namespace

std::string Deck::resolved() const {
  std::string text;
  for (const auto& [section, help] : impl_->sections) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", heading(section));
    for (const auto& d : impl_->declarations) {
      if (d.section != section) continue;
      const std::string line =
          d.value.empty() ? fmt::format("# {} is not set", d.key) : d.key + " = " + d.value;
      text += fmt::format("{:<40}  # {}\n", line, comment(d));
    }
  }
  return text;
}

// FNV-1a, 64 bit, over section.key=value lines.
std::string Deck::fingerprint() const {
  std::string text;
  for (const auto& d : impl_->declarations) text += d.section + "." + d.key + "=" + d.value + "\n";
  return fmt::format("{:016x}", fnv1a(text));
}

std::string Deck::reference() const {
  std::string text;
  for (const auto& [section, help] : impl_->sections) {
    text += fmt::format("{}## {}\n\n", text.empty() ? "" : "\n", heading(section));
    if (!help.empty()) text += plain(help) + "\n\n";
    text += "| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n";
    for (const auto& d : impl_->declarations)
      if (d.section == section)
        text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(d.key), d.type, d.unit,
                            fallback_cell(d), plain(d.bounds), plain(d.help));
  }
  return text;
}

}  // namespace polyslip::core
