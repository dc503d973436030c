#include "results/macro_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::results {

std::string macro_line(const MacroRow& r) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", r.strain, r.time, r.step_size,
                  fmt::join(r.stress, ","), r.fx_x1, r.fy_y1, r.fz_z1, r.newton_iterations,
                  r.linear_iterations, r.remeshed ? 1 : 0, r.load_strain, r.load_stress);
  // Three of them have columns of their own.
  for (std::size_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < 3; ++i)
      if (face != 2 * i + 1) line += fmt::format(",{}", r.face_forces[face][i]);
  return line + "\n";
}

MacroCsv::MacroCsv(std::string path, long rows)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "ab")), rows_(rows) {
  if (!file_)
    throw core::InputError(fmt::format("{}: cannot write: {}", path_, std::strerror(errno)));
}

MacroCsv MacroCsv::create(const std::string& path) {
  core::write_file(path, macro_header + "\n");
  return MacroCsv(path, 0);
}

MacroCsv MacroCsv::resume(const std::string& path, long rows) {
  const std::string text = core::read_text(path);
  if (!text.starts_with(macro_header + "\n"))
    throw core::InputError(fmt::format("{}: is not the macro.csv of a run (first line)", path));
  std::size_t end = macro_header.size() + 1;
  for (long row = 0; row < rows; ++row) {
    const std::size_t newline = text.find('\n', end);
    if (newline == std::string::npos)
      throw core::InputError(
          fmt::format("{}: has {} rows where the checkpoint needs {}; run anew", path, row, rows));
    end = newline + 1;
  }
  if (end != text.size()) core::write_file(path, std::string_view(text).substr(0, end));
  return MacroCsv(path, rows);
}

void MacroCsv::append(const MacroRow& row) {
  const std::string line = macro_line(row);
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() ||
      std::fflush(file_.get()) != 0)
    throw core::InputError(fmt::format("{}: cannot write: {}", path_, std::strerror(errno)));
  ++rows_;
}

void MacroCsv::sync() {
  if (::fsync(::fileno(file_.get())) != 0)
    throw core::InputError(fmt::format("{}: cannot write: {}", path_, std::strerror(errno)));
}

}  // namespace polyslip::results
