#pragma once
// TOML text as values with their places. Only toml.cpp sees the TOML library.

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace polyslip::core {

/// 1-based; line 0: nowhere in the text.
struct Position {
  int line = 0;
  int column = 0;
  auto operator<=>(const Position&) const = default;
};

struct TomlValue;
using TomlList = std::vector<TomlValue>;

/// Date, time or table inside a table: kinds that no deck needs.
struct TomlOther {};

struct TomlValue {
  std::variant<TomlOther, bool, std::int64_t, double, std::string, TomlList> data;
  Position at;
};

/// key = value
struct TomlEntry {
  std::string key;
  Position key_at;
  TomlValue value;
};

/// [name] and its entries, in the order of the text. One of a list, [[name.list]], is a table of
/// its own, "name.list 1" and so on.
struct TomlTable {
  std::string name;
  Position at;  ///< of the name
  std::vector<TomlEntry> entries;
};

struct TomlDocument {
  std::vector<TomlEntry> loose;  ///< before the first table, or where a table should be
  std::vector<TomlTable> tables;
};

/// Throws InputError "<path>:<line>:<column>: <what>" for a fault of syntax.
TomlDocument parse_toml(const std::string& text, const std::string& path);

/// The value as TOML: numbers with as many digits as it takes to read the same number back (an
/// integral one keeps a ".0"), texts quoted and escaped.
std::string toml_text(const TomlValue& value);
std::string toml_text(double number);
std::string toml_text(const std::string& text);

}  // namespace polyslip::core
