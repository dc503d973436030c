// The readers of deck keys: value, declaration, faults.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/deck.hpp"
#include "core/deck_impl.hpp"
#include "core/error.hpp"

namespace polyslip::core {

namespace {

/// "> 0 and <= 1"; empty without bounds.
std::string bounds_text(double min, bool exclusive_min, double max, bool exclusive_max) {
  std::vector<std::string> parts;
  if (min > -unbounded) parts.push_back(fmt::format("{} {}", exclusive_min ? ">" : ">=", min));
  if (max < unbounded) parts.push_back(fmt::format("{} {}", exclusive_max ? "<" : "<=", max));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string bounds_text(const auto& rule) {
  return bounds_text(rule.min, rule.exclusive_min, rule.max, rule.exclusive_max);
}

std::string bounds_text(const IntegerKey& rule) {
  std::vector<std::string> parts;
  if (rule.min > std::numeric_limits<std::int64_t>::min())
    parts.push_back(fmt::format(">= {}", rule.min));
  if (rule.max < std::numeric_limits<std::int64_t>::max())
    parts.push_back(fmt::format("<= {}", rule.max));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string choices_text(const std::vector<std::string>& choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) text += i + 1 == choices.size() ? " or " : ", ";
    text += toml_text(choices[i]);
  }
  return text;
}

bool within(double x, const auto& rule) {
  return (rule.exclusive_min ? x > rule.min : x >= rule.min) &&
         (rule.exclusive_max ? x < rule.max : x <= rule.max);
}

/// A value in a message: not longer than a line can bear.
std::string shown(const TomlValue& value) {
  const std::string text = toml_text(value);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// The number, if `value` is one; an integer literal is.
std::optional<double> as_number(const TomlValue& value) {
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*integer);
  return {};
}

/// Why a number breaks its rule; empty if it does not.
std::string number_fault(const TomlValue& value, const auto& rule) {
  const auto x = as_number(value);
  if (!x) return "must be a number";
  if (!std::isfinite(*x)) return "must be finite";
  return within(*x, rule) ? "" : "must be " + bounds_text(rule);
}

/// Why a text breaks its rule; empty if it does not.
std::string text_fault(const TomlValue& value, const std::vector<std::string>& choices) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (text == nullptr) return "must be a text in quotes";
  if (choices.empty() || std::ranges::find(choices, *text) != choices.end()) return "";
  const std::string nearest = nearest_name(*text, choices);
  return "must be " + choices_text(choices) +
         (nearest.empty() ? "" : "; did you mean " + toml_text(nearest) + "?");
}

std::string list_text(const std::vector<double>& list) {
  TomlValue value;
  TomlList items;
  for (const double x : list) items.push_back({x, {}});
  value.data = std::move(items);
  return toml_text(value);
}

std::string list_text(const std::vector<std::string>& list) {
  TomlValue value;
  TomlList items;
  for (const auto& x : list) items.push_back({x, {}});
  value.data = std::move(items);
  return toml_text(value);
}

/// What is wrong with a value, and where in it.
using Wrong = std::optional<Deck::Impl::Fault>;

Wrong wrong_value(const std::string& key, const TomlValue& value, const std::string& what) {
  if (what.empty()) return {};
  return Deck::Impl::Fault{value.at, fmt::format("{} = {} {}", key, shown(value), what)};
}

/// The first entry of a list that breaks `entry_fault`; a fault if it is no list at all.
Wrong wrong_list(const std::string& key, const TomlValue& value, const char* kind,
                 const auto& entry_fault) {
  const auto* list = std::get_if<TomlList>(&value.data);
  if (list == nullptr) return wrong_value(key, value, kind);
  for (std::size_t i = 0; i < list->size(); ++i) {
    const TomlValue& entry = (*list)[i];
    const std::string what = entry_fault(*list, i);
    if (!what.empty())
      return Deck::Impl::Fault{entry.at,
                               fmt::format("{}: entry {} = {} {}", key, i + 1, shown(entry), what)};
  }
  return {};
}

std::string text_of(const TomlValue& value) { return std::get<std::string>(value.data); }

template <class T>
std::vector<T> list_of(const TomlValue& value, const auto& take) {
  std::vector<T> result;
  for (const auto& item : std::get<TomlList>(value.data)) result.push_back(take(item));
  return result;
}

std::vector<double> numbers_of(const TomlValue& value) {
  return list_of<double>(value, [](const TomlValue& v) { return *as_number(v); });
}

/// Reads one key: the value of the deck, else the default; declares it; notes what is wrong.
template <class T>
std::optional<T> read(Deck::Impl& deck, Declaration declaration, const std::optional<T>& fallback,
                      const auto& check, const auto& take, const auto& write) {
  const std::string section = declaration.section, key = declaration.key;
  for (const auto& d : deck.declarations)
    if (d.section == section && d.key == key)
      throw InternalError("deck key [" + section + "] " + key + " is declared twice");
  std::optional<T> result = fallback;
  if (const auto* entry = deck.find(section, key)) {
    if (const Wrong wrong = check(entry->value))
      deck.key_fault(wrong->at, section, wrong->what);
    else
      result = take(entry->value);
  } else if (!fallback && !declaration.optional) {
    deck.key_fault(deck.place(section, key), section, "missing key '" + key + "'");
  }
  if (fallback) declaration.fallback = write(*fallback);
  if (result) declaration.value = write(*result);
  deck.declarations.push_back(std::move(declaration));
  return result;
}

Declaration number_declaration(const std::string& section, const std::string& key,
                               const NumberKey& rule, bool optional) {
  return {section, key, "number", rule.unit, "", bounds_text(rule), rule.help, "", optional};
}

std::optional<double> read_number(Deck::Impl& deck, const Declaration& declaration,
                                  const NumberKey& rule) {
  return read<double>(
      deck, declaration, rule.fallback,
      [&](const TomlValue& v) { return wrong_value(declaration.key, v, number_fault(v, rule)); },
      [](const TomlValue& v) { return *as_number(v); }, [](double x) { return toml_text(x); });
}

std::optional<std::string> read_text_key(Deck::Impl& deck, const Declaration& declaration,
                                         const TextKey& rule) {
  return read<std::string>(
      deck, declaration, rule.fallback,
      [&](const TomlValue& v) {
        return wrong_value(declaration.key, v, text_fault(v, rule.choices));
      },
      text_of, [](const std::string& x) { return toml_text(x); });
}

Declaration text_declaration(const std::string& section, const std::string& key,
                             const TextKey& rule, bool optional) {
  return {section, key, "text", "", "", choices_text(rule.choices), rule.help, "", optional};
}

std::string increasing_fault(const TomlList& list, std::size_t i) {
  if (i == 0 || *as_number(list[i]) > *as_number(list[i - 1])) return "";
  return "must be larger than the entry before it";
}

std::string twice_fault(const TomlList& list, std::size_t i) {
  for (std::size_t j = 0; j < i; ++j)
    if (text_of(list[j]) == text_of(list[i])) return "is there twice";
  return "";
}

}  // namespace

double Deck::Table::number(const std::string& key, const NumberKey& rule) {
  return read_number(*deck_, number_declaration(section_, key, rule, false), rule)
      .value_or(std::nan(""));
}

std::optional<double> Deck::Table::optional_number(const std::string& key, const NumberKey& rule) {
  return read_number(*deck_, number_declaration(section_, key, rule, true), rule);
}

std::int64_t Deck::Table::integer(const std::string& key, const IntegerKey& rule) {
  const auto fault = [&](const TomlValue& v) -> std::string {
    const auto* x = std::get_if<std::int64_t>(&v.data);
    if (x == nullptr) return "must be an integer";
    return *x >= rule.min && *x <= rule.max ? "" : "must be " + bounds_text(rule);
  };
  return read<std::int64_t>(
             *deck_,
             {section_, key, "integer", rule.unit, "", bounds_text(rule), rule.help, "", false},
             rule.fallback, [&](const TomlValue& v) { return wrong_value(key, v, fault(v)); },
             [](const TomlValue& v) { return std::get<std::int64_t>(v.data); },
             [](std::int64_t x) { return std::to_string(x); })
      .value_or(0);
}

bool Deck::Table::boolean(const std::string& key, const BooleanKey& rule) {
  return read<bool>(
             *deck_, {section_, key, "true or false", "", "", "", rule.help, "", false},
             rule.fallback,
             [&](const TomlValue& v) {
               return wrong_value(
                   key, v, std::holds_alternative<bool>(v.data) ? "" : "must be true or false");
             },
             [](const TomlValue& v) { return std::get<bool>(v.data); },
             [](bool x) { return std::string(x ? "true" : "false"); })
      .value_or(false);
}

std::string Deck::Table::text(const std::string& key, const TextKey& rule) {
  return read_text_key(*deck_, text_declaration(section_, key, rule, false), rule).value_or("");
}

std::optional<std::string> Deck::Table::optional_text(const std::string& key, const TextKey& rule) {
  return read_text_key(*deck_, text_declaration(section_, key, rule, true), rule);
}

std::optional<std::string> Deck::Table::optional_file(const std::string& key, const TextKey& rule) {
  const auto given = optional_text(key, rule);
  if (!given) return {};
  namespace fs = std::filesystem;
  const std::string file = (fs::path(deck_->path).parent_path() / *given).string();
  auto& value = deck_->declarations.back().value;
  if (!value.empty()) value = toml_text(fs::absolute(file).lexically_normal().string());
  return file;
}

std::vector<double> Deck::Table::numbers(const std::string& key, const NumbersKey& rule) {
  const auto entry_fault = [&](const TomlList& list, std::size_t i) {
    const std::string fault = number_fault(list[i], rule);
    return fault.empty() && rule.increasing ? increasing_fault(list, i) : fault;
  };
  std::string bounds = bounds_text(rule);
  if (rule.increasing) bounds += bounds.empty() ? "increasing" : ", increasing";
  return read<std::vector<double>>(
             *deck_,
             {section_, key, "list of numbers", rule.unit, "", bounds, rule.help, "", false},
             rule.fallback,
             [&](const TomlValue& v) {
               return wrong_list(key, v, "must be a list of numbers", entry_fault);
             },
             numbers_of, [](const std::vector<double>& x) { return list_text(x); })
      .value_or(std::vector<double>{});
}

std::optional<std::vector<double>> Deck::Table::optional_numbers(const std::string& key,
                                                                 std::size_t count,
                                                                 const NumbersKey& rule) {
  const std::string kind = fmt::format("must be a list of {} numbers", count);
  const auto check = [&](const TomlValue& v) {
    const auto* list = std::get_if<TomlList>(&v.data);
    if (list != nullptr && list->size() != count) return wrong_value(key, v, kind);
    return wrong_list(key, v, kind.c_str(), [&](const TomlList& entries, std::size_t i) {
      return number_fault(entries[i], rule);
    });
  };
  return read<std::vector<double>>(*deck_,
                                   {section_, key, fmt::format("{} numbers", count), rule.unit, "",
                                    bounds_text(rule), rule.help, "", true},
                                   std::nullopt, check, numbers_of,
                                   [](const std::vector<double>& x) { return list_text(x); });
}

std::optional<std::vector<std::vector<double>>> Deck::Table::optional_rows(const std::string& key,
                                                                           std::size_t columns,
                                                                           const NumbersKey& rule) {
  using Rows = std::vector<std::vector<double>>;
  const std::string kind = fmt::format("must be a list of lists of {} numbers", columns);
  const auto row_fault = [&](const TomlList& rows, std::size_t i) -> std::string {
    const auto* row = std::get_if<TomlList>(&rows[i].data);
    if (row == nullptr || row->size() != columns)
      return fmt::format("must be a list of {} numbers", columns);
    for (const TomlValue& entry : *row)
      if (const std::string fault = number_fault(entry, rule); !fault.empty())
        return fmt::format("holds {}, which {}", shown(entry), fault);
    return "";
  };
  const auto check = [&](const TomlValue& v) {
    const auto* list = std::get_if<TomlList>(&v.data);
    if (list != nullptr && list->empty()) return wrong_value(key, v, kind);
    return wrong_list(key, v, kind.c_str(), row_fault);
  };
  const auto write = [](const Rows& rows) {
    std::vector<std::string> texts;
    for (const auto& row : rows) texts.push_back(list_text(row));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  };
  return read<Rows>(
      *deck_,
      {section_, key, fmt::format("list of lists of {} numbers", columns), rule.unit, "",
       bounds_text(rule), rule.help, "", true},
      std::nullopt, check,
      [](const TomlValue& v) { return list_of<std::vector<double>>(v, numbers_of); }, write);
}

Vec3 Deck::Table::vector3(const std::string& key, const NumbersKey& rule) {
  const char* kind = "must be a list of three numbers";
  const auto check = [&](const TomlValue& v) {
    const auto* list = std::get_if<TomlList>(&v.data);
    if (list != nullptr && list->size() != 3) return wrong_value(key, v, kind);
    return wrong_list(key, v, kind, [&](const TomlList& entries, std::size_t i) {
      return number_fault(entries[i], rule);
    });
  };
  const auto list = read<std::vector<double>>(
      *deck_,
      {section_, key, "three numbers", rule.unit, "", bounds_text(rule), rule.help, "", false},
      rule.fallback, check, numbers_of, [](const std::vector<double>& x) { return list_text(x); });
  if (!list) return Vec3::Constant(std::nan(""));
  if (list->size() != 3) throw InternalError("default of [" + section_ + "] " + key);
  return {(*list)[0], (*list)[1], (*list)[2]};
}

std::vector<std::string> Deck::Table::texts(const std::string& key, const TextsKey& rule) {
  const auto entry_fault = [&](const TomlList& list, std::size_t i) {
    const std::string fault = text_fault(list[i], rule.choices);
    return fault.empty() && rule.unique ? twice_fault(list, i) : fault;
  };
  const auto check = [&](const TomlValue& v) {
    const auto* list = std::get_if<TomlList>(&v.data);
    if (list != nullptr && list->empty() && rule.not_empty)
      return wrong_value(key, v, "must name at least one");
    return wrong_list(key, v, "must be a list of texts", entry_fault);
  };
  std::string bounds = rule.choices.empty() ? "" : "of " + choices_text(rule.choices);
  if (rule.unique) bounds += bounds.empty() ? "each once" : ", each once";
  if (rule.not_empty) bounds += bounds.empty() ? "at least one" : ", at least one";
  return read<std::vector<std::string>>(
             *deck_, {section_, key, "list of texts", "", "", bounds, rule.help, "", false},
             rule.fallback, check,
             [](const TomlValue& v) { return list_of<std::string>(v, text_of); },
             [](const std::vector<std::string>& x) { return list_text(x); })
      .value_or(std::vector<std::string>{});
}

}  // namespace polyslip::core
