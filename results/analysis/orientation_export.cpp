#include "results/analysis/orientation_export.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "results/analysis/run_sample.hpp"

namespace polyslip::results::analysis {

std::string mtex_text(const Sample& sample) {
  const Sample s = normalised(sample);
  std::string text = "# phi1 Phi phi2 weights\n";
  for (std::size_t i = 0; i < s.size(); ++i) {
    const core::Vec3 bunge = core::to_bunge(s.orientations[i]);
    text += fmt::format("{} {} {} {}\n", bunge[0], bunge[1], bunge[2], s.weights[i]);
  }
  return text;
}

std::string ori_text(const Sample& sample) {
  std::string text;
  for (const auto& q : sample.orientations)
    text += fmt::format("{} {} {} {}\n", q.w(), q.x(), q.y(), q.z());
  return text;
}

std::string export_format(const std::string& path) {
  return std::filesystem::path(path).extension() == ".ori" ? "ori" : "csv";
}

StateRecord export_orientations(const std::string& run_folder, double strain,
                                const std::string& path, const std::string& format,
                                bool overwrite) {
  if (!std::isfinite(strain))
    throw core::InputError(fmt::format("strain {}: give a finite number", strain));
  const StateSeries series = begun_series(run_folder);
  if (std::filesystem::exists(path) && !overwrite)
    throw core::InputError(path +
                           ": is there; give another name with --to, or replace it with "
                           "--overwrite");
  const StateRecord state = nearest_state(series, strain);
  const Sample sample = read_run_sample(series.path(state)).sample;
  core::write_file(path, format == "mtex" ? mtex_text(sample) : ori_text(sample));
  return state;
}

}  // namespace polyslip::results::analysis
