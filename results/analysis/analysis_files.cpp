#include "results/analysis/analysis_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/analysis/analysis_figures.hpp"
#include "results/analysis/analysis_tables.hpp"
#include "results/analysis/grain_figures.hpp"
#include "results/names.hpp"
#include "results/plot.hpp"

namespace polyslip::results::analysis {
namespace {

namespace fs = std::filesystem;

/// Writes into one folder and remembers the names.
class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {}
  void put(const std::string& name, const std::string& text) {
    core::write_file(in_folder(path_, name), text);
    names.push_back(name);
  }
  void put(const std::string& name, const std::vector<Plot>& plots, const std::string& caption) {
    if (plots.empty() || plots.front().series.empty()) return;
    put(name, svg_text(plots, caption));
  }
  std::vector<std::string> names;

 private:
  std::string path_;
};

std::string in_analysis(const std::string& name) { return in_folder(analysis_folder, name); }

void put_pole_figures(Folder& out, const Analysis& a, std::size_t state) {
  const Sample sample = a.texture_sample(state);
  const AnalysisOptions& o = a.options;
  const std::string at = fmt::format("{:.4g}", a.textures[state].strain);
  std::string rows = pole_figure_header;
  std::vector<MapPanel> panels;
  for (const auto& hkl : {std::array{1, 1, 1}, std::array{2, 0, 0}, std::array{2, 2, 0}}) {
    const std::string name = fmt::format("{}{}{}", hkl[0], hkl[1], hkl[2]);
    const auto grid = disc_grid(PoleFigure(sample, hkl, o.half_width, o.symmetry), 61, o.threads);
    rows += pole_figure_rows(grid, name);
    panels.push_back(pole_figure_panel(grid, "{" + name + "}"));
  }
  out.put(in_analysis("pole-figures-" + at + ".csv"), rows);
  out.put(in_analysis("pole-figures-" + at + ".svg"),
          map_svg(panels, 3, "Pole figures at strain " + at));
  rows = pole_figure_header;
  panels.clear();
  const std::pair<const char*, core::Vec3> axes[] = {
      {"RD", {1, 0, 0}}, {"TD", {0, 1, 0}}, {"ND", {0, 0, 1}}};
  for (const auto& [name, axis] : axes) {
    const auto grid =
        triangle_grid(InversePoleFigure(sample, axis, o.half_width, o.symmetry), 59, o.threads);
    rows += inverse_pole_figure_rows(grid, name);
    panels.push_back(inverse_pole_figure_panel(grid, name));
  }
  out.put(in_analysis("inverse-pole-figures-" + at + ".csv"), rows);
  out.put(in_analysis("inverse-pole-figures-" + at + ".svg"),
          map_svg(panels, 3, "Inverse pole figures at strain " + at));
}

void put_sections(Folder& out, const Analysis& a, std::size_t state) {
  const Odf odf(a.texture_sample(state), a.options.half_width, a.options.symmetry);
  const std::string at = fmt::format("{:.4g}", a.textures[state].strain);
  const auto bunge = bunge_grid(odf, 5, a.options.threads);
  out.put(in_analysis("odf-bunge-" + at + ".csv"), bunge_csv(bunge));
  out.put(in_analysis("odf-bunge-" + at + ".svg"),
          map_svg(bunge_panels(bunge), bunge.n1 > bunge.n ? 3 : 5,
                  "Sections of the ODF across phi2 at strain " + at));
  const auto rodrigues = rodrigues_grid(odf, 33, a.options.threads);
  out.put(in_analysis("odf-rodrigues-" + at + ".csv"), rodrigues_csv(rodrigues));
  out.put(in_analysis("odf-rodrigues-" + at + ".svg"),
          map_svg(rodrigues_panels(sections_of(rodrigues)), 4,
                  "Sections of the ODF in Rodrigues space at strain " + at));
}

void put_spreads(Folder& out, const Analysis& a, const std::vector<int>& drawn) {
  out.put("spreads.csv", spreads_csv(a));
  out.put(in_analysis("spread-summary.csv"), spread_summary_csv(a));
  out.put(in_analysis("spread-distribution.svg"), spread_plots(a),
          "Distribution of in-grain orientation spreads");
  out.put(in_analysis("spread-correlation.svg"), correlation_plots(a),
          "In-grain orientation spreads from strain to strain");
  if (!has_spread(a, a.spreads.size() - 1)) return;
  std::vector<GrainPicture> pictures;
  for (const int grain : drawn) pictures.push_back(grain_picture(a, grain));
  out.put(in_analysis("rotation-paths.svg"), path_svg(a, pictures));
  for (const GrainPicture& picture : pictures)
    out.put(in_analysis(fmt::format("grain-{}.svg", picture.grain + 1)), grain_plots(a, picture),
            fmt::format("Orientations of grain {} about their mean", picture.grain + 1));
}

}  // namespace

std::string texture_csv(const Analysis& a) {
  std::string text = "strain,component,intensity,volume_fraction\n";
  for (const auto& t : a.textures)
    for (const auto& c : t.components)
      text += fmt::format("{},{},{},{}\n", t.strain, c.name, c.intensity, c.volume_fraction);
  return text;
}

std::vector<std::string> analysis_files(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto name : {texture_name, spreads_name})
    if (fs::exists(in_folder(folder, name))) names.emplace_back(name);
  std::error_code error;
  for (fs::directory_iterator it(in_folder(folder, analysis_folder), error), end;
       !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (it->is_regular_file() && is_analysis_file(name) && !name.starts_with("compare"))
      names.push_back(in_analysis(name));
  }
  std::sort(names.begin(), names.end());
  return names;
}

void check_analysis_folder(const std::string& folder, bool overwrite) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw core::InputError(folder + ": is a file, not a folder; give a folder with --to");
  const auto earlier = analysis_files(folder);
  if (!earlier.empty() && !overwrite)
    throw core::InputError(fmt::format(
        "{}: holds an earlier analysis ({}); give another folder with --to, or replace it with "
        "--overwrite",
        folder, earlier.front()));
  if (fs::exists(folder)) core::require_writable_folder(folder);
}

std::vector<std::string> write_analysis(const std::string& folder, const Analysis& a,
                                        const FileOptions& options) {
  check_analysis_folder(folder, options.overwrite);
  std::vector<int> drawn;
  if (!a.spreads.empty()) drawn = drawn_grains(a, options.grains);
  for (const auto& name : analysis_files(folder)) fs::remove(in_folder(folder, name));
  core::make_folder(in_folder(folder, analysis_folder));
  Folder out(folder);
  out.put(std::string(texture_name), texture_csv(a));
  out.put(in_analysis("texture-index.csv"), index_csv(a));
  out.put(in_analysis("beta-fibre.csv"), beta_csv(a));
  out.put(in_analysis("components.svg"), component_plots(a), "Texture components against strain");
  out.put(in_analysis("beta-fibre.svg"), beta_plots(a), "Intensity along the beta-fibre");
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    put_pole_figures(out, a, i);
    if (options.all_maps || i + 1 == a.samples.size()) put_sections(out, a, i);
  }
  if (!a.spreads.empty()) put_spreads(out, a, drawn);
  out.put(in_analysis("analysis.json"), analysis_json(a));
  return out.names;
}

}  // namespace polyslip::results::analysis
