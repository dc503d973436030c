#include "results/convert.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace polyslip::results {
namespace {

void add_row(fmt::memory_buffer& text, int grain, const ElementTable& t, std::size_t e) {
  const auto& x = t.centroid[e];
  const auto& q = t.orientation[e];
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", e + 1,
                 grain + 1, x[0], x[1], x[2], t.volume[e], q.w(), q.x(), q.y(), q.z(), t.g[e],
                 t.slip[e], t.equivalent_strain[e],
                 fmt::join(t.cauchy_stress[e].begin(), t.cauchy_stress[e].end(), ","),
                 t.pressure[e]);
}

/// Row by row, so that a large table never stands in memory as text.
void write_table(const std::string& path, const std::vector<int>& grain,
                 const ElementTable& table) {
  constexpr std::size_t chunk = 1 << 20;
  std::ofstream out(core::part_path(path), std::ios::binary | std::ios::trunc);
  if (!out) throw core::InputError(path + ": cannot write; is there such a folder?");
  fmt::memory_buffer text;
  text.append(element_header + "\n");
  const auto flush = [&] {
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  };
  for (std::size_t e = 0; e < grain.size(); ++e) {
    add_row(text, grain[e], table, e);
    if (text.size() > chunk) flush();
  }
  flush();
  out.close();
  if (!out) {
    std::remove(core::part_path(path).c_str());
    throw core::InputError(path + ": cannot write; is the disk full?");
  }
  core::publish_part(path);
}

/// A table of an earlier conversion may be replaced; any other file, once lost, is lost.
void check_target(const std::string& csv, bool overwrite) {
  if (std::filesystem::is_directory(csv))
    throw core::InputError(csv + ": is a folder; give the name of a file with --to");
  if (overwrite || !std::filesystem::exists(csv)) return;
  std::string line;
  std::ifstream in(csv);
  std::getline(in, line);
  if (line != element_header)
    throw core::InputError(csv +
                           ": is there and is no table of elements; give another name with --to, "
                           "or replace it with --overwrite");
}

}  // namespace

StateRecord convert(const std::string& run_folder, double strain, const std::string& csv,
                    ElementValue value, bool overwrite) {
  if (!std::isfinite(strain))
    throw core::InputError(fmt::format("strain {}: give a finite number", strain));
  const StateSeries series = begun_series(run_folder);
  const StateRecord state = nearest_state(series, strain);
  check_target(csv, overwrite);
  if (series.without_mesh()) {
    const auto orientations = read_orientation_state(series.path(state));
    std::vector<int> grain(orientations.table.volume.size());
    std::iota(grain.begin(), grain.end(), 0);
    write_table(csv, grain, orientations.table);
  } else {
    const auto snapshot = read_state(series.path(state));
    write_table(csv, snapshot.mesh.tetrahedron_cell, element_values(snapshot, value));
  }
  return state;
}

}  // namespace polyslip::results
