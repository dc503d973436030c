#include "drivers/analyse_verb.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "drivers/options.hpp"
#include "drivers/orientations.hpp"
#include "results/analysis/analysis_files.hpp"
#include "results/analysis/compare.hpp"
#include "results/names.hpp"

namespace polyslip::drivers {
namespace {

namespace fs = std::filesystem;
namespace ra = results::analysis;

/// [texture] of the deck that a folder was made by; the defaults without one.
TextureOptions texture_options(const std::string& folder) {
  const std::string deck_path = results::in_folder(folder, results::resolved_deck_name);
  if (!fs::exists(deck_path)) return {};
  core::Deck deck = core::Deck::from_file(deck_path);
  return read_options(deck, Purpose::mesh).texture;
}

ra::AnalysisOptions analysis_options(const AnalyseRequest& request, const TextureOptions& deck) {
  ra::AnalysisOptions o;
  o.half_width = request.half_width.value_or(deck.half_width) / core::degrees_per_radian;
  o.symmetry = request.sample_symmetry.value_or(deck.sample_symmetry) == "orthorhombic"
                   ? ra::SampleSymmetry::orthorhombic
                   : ra::SampleSymmetry::none;
  o.inner = request.inner;
  o.one_mode = request.one_mode;
  o.at_strains = request.at_strains;
  o.threads = request.threads;
  return o;
}

ra::Analysis analyse_input(const AnalyseRequest& request) {
  if (!fs::exists(request.input))
    throw core::InputError(request.input + ": no such file or folder");
  if (fs::is_directory(request.input))
    return ra::analyse_folder(request.input,
                              analysis_options(request, texture_options(request.input)));
  if (request.inner || request.one_mode || !request.at_strains.empty() || !request.grains.empty())
    throw core::InputError(request.input +
                           ": a file of orientations has no grains or strains; leave --inner, "
                           "--one-mode, --at-strains and --grains out");
  auto [orientations, weights] = read_weighted_orientations(
      request.input,
      request.convention.empty() ? convention_of_file(request.input) : request.convention);
  return ra::analyse_sample({std::move(orientations), std::move(weights)},
                            analysis_options(request, {}));
}

void print_textures(const ra::Analysis& a) {
  std::cout << fmt::format("{:>8} {:>9}", "strain", "index");
  for (const auto& c : a.textures.front().components) std::cout << fmt::format(" {:>12}", c.name);
  std::cout << '\n';
  for (const auto& t : a.textures) {
    std::cout << fmt::format("{:8.4g} {:9.3f}", t.strain, t.integrals.texture_index);
    for (const auto& c : t.components) std::cout << fmt::format(" {:12.3f}", c.intensity);
    std::cout << '\n';
  }
  if (a.spread_summaries.empty()) return;
  std::cout << "\n  strain    grains  mean spread  correlation with the strain before\n";
  for (const auto& s : a.spread_summaries)
    std::cout << fmt::format(
        "{:8.4g} {:9} {:9.2f} deg {}\n", s.strain, s.grains, s.mean,
        std::isfinite(s.correlation) ? fmt::format("{:9.3f}", s.correlation) : "        -");
}

}  // namespace

void analyse(const AnalyseRequest& request) {
  std::string to = request.to;
  if (to.empty())
    to = fs::is_directory(request.input) ? request.input
                                         : fs::path(request.input).stem().string() + "-analysis";
  ra::check_analysis_folder(to, request.overwrite);
  const ra::Analysis analysis = analyse_input(request);
  ra::FileOptions files{request.overwrite, request.all_maps, {}};
  for (const int grain : request.grains) files.grains.push_back(grain - 1);
  const auto names = ra::write_analysis(to, analysis, files);
  print_textures(analysis);
  std::cout << fmt::format("\nwritten to {}: {} files, {} and {}/ among them\n", to, names.size(),
                           results::texture_name, results::analysis_folder);
}

void compare(const CompareRequest& request) {
  for (const auto& folder : {request.run, request.taylor})
    if (!fs::is_directory(folder)) throw core::InputError(folder + ": no such folder");
  const std::string to = request.to.empty() ? request.run : request.to;
  ra::check_comparison_place(to, request.how.overwrite);
  const auto comparison = ra::compare_folders(
      request.run, request.taylor, analysis_options(request.how, texture_options(request.run)));
  const auto names =
      ra::write_comparison(to, comparison, request.run, request.taylor, request.how.overwrite);
  std::cout << "times random, run / Taylor\n" << fmt::format("{:>8} {:>15}", "strain", "index");
  for (const auto& c : comparison.run.textures.front().components)
    std::cout << fmt::format(" {:>15}", c.name);
  std::cout << '\n';
  for (std::size_t i = 0; i < comparison.run.textures.size(); ++i) {
    const auto &r = comparison.run.textures[i], &t = comparison.taylor.textures[i];
    const auto pair = [](double a, double b) {
      return fmt::format(" {:>15}", fmt::format("{:.2f} / {:.2f}", a, b));
    };
    std::cout << fmt::format("{:8.4g}", r.strain)
              << pair(r.integrals.texture_index, t.integrals.texture_index);
    for (std::size_t k = 0; k < r.components.size(); ++k)
      std::cout << pair(r.components[k].intensity, t.components[k].intensity);
    std::cout << '\n';
  }
  std::cout << fmt::format("\nwritten to {}: {} and {} figures\n", to, names.front(),
                           names.size() - 1);
}

}  // namespace polyslip::drivers
