#include "core/toml.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace polyslip::core {

namespace {

Position position(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

TomlValue convert(const toml::node& node) {
  TomlValue value;
  value.at = position(node.source());
  if (const auto* boolean = node.as_boolean())
    value.data = boolean->get();
  else if (const auto* integer = node.as_integer())
    value.data = integer->get();
  else if (const auto* number = node.as_floating_point())
    value.data = number->get();
  else if (const auto* text = node.as_string())
    value.data = text->get();
  else if (const auto* array = node.as_array()) {
    TomlList list;
    for (const auto& item : *array) list.push_back(convert(item));
    value.data = std::move(list);
  }
  return value;
}

TomlEntry entry(const toml::key& key, const toml::node& node) {
  return {std::string(key.str()), position(key.source()), convert(node)};
}

TomlTable table_of(std::string name, Position at, const toml::table& table) {
  TomlTable section{std::move(name), at, {}};
  for (const auto& [key, value] : table) section.entries.push_back(entry(key, value));
  return section;
}

/// Takes the lists of tables out of a table, as tables of their own.
void take_lists(TomlDocument& document, const std::string& name, const toml::table& table,
                TomlTable& section) {
  for (const auto& [key, value] : table) {
    const auto* list = value.as_array();
    if (list == nullptr || list->empty() || !list->is_homogeneous<toml::table>()) continue;
    std::erase_if(section.entries, [&](const TomlEntry& e) { return e.key == key.str(); });
    int number = 0;
    for (const auto& item : *list)
      document.tables.push_back(table_of(fmt::format("{}.{} {}", name, key.str(), ++number),
                                         position(item.source()), *item.as_table()));
  }
}

bool earlier(const TomlEntry& a, const TomlEntry& b) { return a.key_at < b.key_at; }

/// The library's message on one line, without its opening words.
std::string one_line(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  const std::string opening = "Error while ";
  if (message.rfind(opening, 0) == 0) message.erase(0, opening.size());
  return message;
}

std::string escaped(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    default:
      break;
  }
  const auto code = static_cast<unsigned char>(c);
  if (code < 0x20 || code == 0x7f) return fmt::format("\\u{:04X}", code);
  return std::string(1, c);
}

}  // namespace

TomlDocument parse_toml(const std::string& text, const std::string& path) {
  toml::table root;
  try {
    root = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const Position at = position(error.source());
    throw InputError(fmt::format("{}:{}:{}: {}", path, at.line, at.column,
                                 one_line(std::string(error.description()))));
  }
  TomlDocument document;
  for (const auto& [key, node] : root) {
    const auto* table = node.as_table();
    if (table == nullptr) {
      document.loose.push_back(entry(key, node));
      continue;
    }
    TomlTable section = table_of(std::string(key.str()), position(key.source()), *table);
    take_lists(document, section.name, *table, section);
    document.tables.push_back(std::move(section));
  }
  for (TomlTable& table : document.tables) std::ranges::sort(table.entries, earlier);
  std::ranges::sort(document.loose, earlier);
  std::ranges::sort(document.tables, {}, &TomlTable::at);
  return document;
}

std::string toml_text(double number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", number);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += escaped(c);
  return quoted + "\"";
}

std::string toml_text(const TomlValue& value) {
  struct Writer {
    std::string operator()(TomlOther) const { return "(table, date or time)"; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return std::to_string(i); }
    std::string operator()(double d) const { return toml_text(d); }
    std::string operator()(const std::string& s) const { return toml_text(s); }
    std::string operator()(const TomlList& list) const {
      std::string text = "[";
      for (const auto& item : list) text += (text.size() > 1 ? ", " : "") + toml_text(item);
      return text + "]";
    }
  };
  return std::visit(Writer{}, value.data);
}

}  // namespace polyslip::core
