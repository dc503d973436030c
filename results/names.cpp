#include "results/names.hpp"

#include <fmt/format.h>

#include <charconv>

namespace polyslip::results {

std::string numbered(std::string_view prefix, int number, int digits, std::string_view suffix) {
  return fmt::format("{}{:0{}}{}", prefix, number, digits, suffix);
}

int number_in(std::string_view name, std::string_view prefix, std::string_view suffix) {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) ||
      !name.ends_with(suffix))
    return -1;
  const auto digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return -1;
  int number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() ? number : -1;
}

bool is_analysis_file(std::string_view name) {
  for (const std::string_view start :
       {"texture-index.csv", "beta-fibre.", "spread-", "pole-figures-", "inverse-pole-figures-",
        "odf-", "components.svg", "rotation-paths.svg", "grain-", "compare", "analysis.json"})
    if (name.starts_with(start)) return true;
  return false;
}

bool is_figure_file(std::string_view name) {
  if (name == texture_name || name == spreads_name || is_analysis_file(name)) return true;
  for (const std::string_view stem : {"stress-strain", "steps", "means", "mesh-quality"})
    for (const std::string_view extension : {".svg", ".csv"})
      if (name.starts_with(stem) && name.substr(stem.size()) == extension) return true;
  return false;
}

}  // namespace polyslip::results
