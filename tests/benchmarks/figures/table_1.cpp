// Table 1: CPU seconds, memory and elements against the number of grains.

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/error.hpp"
#include "figures.hpp"

namespace polyslip::figures {
namespace {

using results::Mark;
using results::Plot;
using results::Series;

struct Row {
  double grains = 0, element_size = 0, cpu_s = 0, memory_mb = 0, elements = 0, nodes = 0;
};

/// Table 1 of the paper. Its number of nodes for 10,000 grains at 0.50 is a misprint (fewer nodes
/// than elements), and left out.
constexpr std::array<Row, 10> paper{{{100, 0.50, 43, 20, 18e3, 27e3},
                                     {300, 0.50, 113, 33, 58e3, 82e3},
                                     {1000, 0.50, 444, 82, 194e3, 270e3},
                                     {3000, 0.50, 1840, 219, 582e3, 798e3},
                                     {10000, 0.50, 7350, 1455, 1953e3, 0},
                                     {100, 0.25, 68, 35, 65e3, 93e3},
                                     {300, 0.25, 209, 78, 190e3, 269e3},
                                     {1000, 0.25, 790, 230, 639e3, 887e3},
                                     {3000, 0.25, 3006, 658, 1907e3, 2621e3},
                                     {10000, 0.25, 17160, 2142, 6332e3, 8640e3}}};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Rows of a CSV file of mesh_quality.
void read_rows(const std::string& path, std::vector<Row>& rows) {
  std::ifstream in(path);
  std::string line;
  if (!std::getline(in, line)) throw core::InputError(path + ": no such table");
  const auto names = split(line);
  while (std::getline(in, line)) {
    const auto cells = split(line);
    const auto value = [&](const std::string& name) {
      for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i)
        if (names[i] == name) return std::stod(cells[i]);
      throw core::InputError(path + ": has no column " + name);
    };
    const double grains = value("grains");
    const double cpu_ms = value("tessellation_ms_a_grain") + value("regularisation_ms_a_grain") +
                          value("meshing_ms_a_grain");
    rows.push_back({grains, value("c_l"), 1e-3 * grains * cpu_ms, value("peak_MB"),
                    value("elements"), value("nodes")});
  }
}

template <class Rows, class Value>
Series series_of(const Rows& rows, double element_size, const std::string& label, Mark mark,
                 Value value) {
  Series s{label, mark};
  for (const Row& r : rows)
    if (r.element_size == element_size) {
      s.x.push_back(r.grains);
      s.y.push_back(value(r));
    }
  return s;
}

template <class Value>
Plot panel(const std::string& title, const std::string& label, const std::vector<Row>& rows,
           Value value) {
  Plot plot{.title = title};
  plot.x = {.label = "grains", .logarithmic = true};
  plot.y = {.label = label, .logarithmic = true};
  for (const double size : {0.50, 0.25}) {
    const std::string at = fmt::format(", c_l = {:.2f}", size);
    plot.series.push_back(series_of(paper, size, "paper" + at, Mark::dashed, value));
    Series here = series_of(rows, size, "here" + at, Mark::line, value);
    if (here.x.empty()) continue;
    plot.series.push_back(here);
  }
  return plot;
}

Figure table_1(const Options& o) {
  std::vector<Row> rows;
  for (const std::string& path : o.tables) read_rows(path, rows);
  if (rows.empty())
    throw core::InputError("table-1: give the CSV files of mesh_quality by --table");
  std::string text =
      "| grains | c_l | CPU s, paper | here | RAM MB, paper | here | elements, paper | here | "
      "nodes, paper | here |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& p : paper)
    for (const Row& r : rows)
      if (r.grains == p.grains && r.element_size == p.element_size)
        fmt::format_to(std::back_inserter(text),
                       "| {:.0f} | {:.2f} | {:.0f} | {:.1f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | "
                       "{} | {:.0f} |\n",
                       r.grains, r.element_size, p.cpu_s, r.cpu_s, p.memory_mb, r.memory_mb,
                       p.elements, r.elements,
                       p.nodes > 0 ? fmt::format("{:.0f}", p.nodes) : std::string("-"), r.nodes);
  return {"CPU time and memory of generating and meshing polycrystals (table 1)",
          {panel("CPU time", "CPU time [s]", rows, [](const Row& r) { return r.cpu_s; }),
           panel("memory", "memory [MB]", rows, [](const Row& r) { return r.memory_mb; }),
           panel("elements", "elements", rows, [](const Row& r) { return r.elements; })},
          text};
}

}  // namespace

std::map<std::string, Maker> table_figures() { return {{"table-1", table_1}}; }

}  // namespace polyslip::figures
