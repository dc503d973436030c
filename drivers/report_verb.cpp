#include "drivers/report_verb.hpp"

#include <filesystem>

#include "core/deck.hpp"
#include "core/rotation.hpp"
#include "results/names.hpp"
#include "results/report/report.hpp"

namespace polyslip::drivers {
namespace {

/// [texture] of the deck that a folder was made by; the defaults without one.
TextureOptions texture_of(const std::string& folder) {
  const std::string path = results::in_folder(folder, results::resolved_deck_name);
  if (!std::filesystem::exists(path)) return {};
  core::Deck deck = core::Deck::from_file(path);
  return read_options(deck, Purpose::mesh).texture;
}

}  // namespace

std::string write_report(const ReportRequest& request) {
  return write_report(request, texture_of(request.folder));
}

std::string write_report(const ReportRequest& request, const TextureOptions& texture) {
  results::analysis::AnalysisOptions options;
  options.half_width = texture.half_width / core::degrees_per_radian;
  if (texture.sample_symmetry == "orthorhombic")
    options.symmetry = results::analysis::SampleSymmetry::orthorhombic;
  return results::report::write_report(
      {.sources = {.folder = request.folder, .taylor = request.taylor, .texture = options},
       .page = results::report::page_path(),
       .overwrite = request.overwrite});
}

}  // namespace polyslip::drivers
