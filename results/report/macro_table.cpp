#include "results/report/macro_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::results::report {
namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    cells.push_back(line.substr(at, comma - at));
    at = comma + 1;
  }
  return cells;
}

}  // namespace

const std::vector<double>& MacroTable::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw core::InternalError("results/report: macro.csv has no column " + name);
  return columns[static_cast<std::size_t>(found - names.begin())];
}

MacroTable read_macro(const std::string& path) {
  const std::string text = core::read_text(path);
  MacroTable table;
  std::size_t number = 0;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const auto cells = cells_of(std::string_view(text).substr(at, end - at));
    if (++number == 1) {
      table.names.assign(cells.begin(), cells.end());
      table.columns.resize(cells.size());
      continue;
    }
    bool fine = cells.size() == table.names.size();
    for (std::size_t i = 0; fine && i < cells.size(); ++i) {
      double value = 0;
      const auto [rest, error] =
          std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), value);
      fine = error == std::errc() && rest == cells[i].data() + cells[i].size();
      table.columns[i].push_back(value);
    }
    if (!fine)
      throw core::InputError(
          fmt::format("{}:{}: is not a row of {} numbers", path, number, table.names.size()));
  }
  return table;
}

}  // namespace polyslip::results::report
