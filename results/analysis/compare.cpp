#include "results/analysis/compare.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/analysis/analysis_figures.hpp"
#include "results/analysis/texture_maps.hpp"
#include "results/names.hpp"

namespace polyslip::results::analysis {
namespace {

constexpr double same = 1e-3;  // strain
const std::string table_name = "compare.csv";

std::vector<double> stored_strains(const std::string& folder) {
  std::vector<double> strains;
  for (const auto& state : chosen_states(begun_series(folder), {})) strains.push_back(state.strain);
  return strains;
}

bool holds(const std::vector<double>& strains, double strain) {
  for (const double s : strains)
    if (std::abs(s - strain) <= same) return true;
  return false;
}

/// The path of the load and von Mises stress of each row of macro.csv.
Series stress_curve(const std::string& folder, const std::string& label, Mark mark) {
  Series series{label, mark, {}, {}};
  std::istringstream lines(core::read_text(in_folder(folder, macro_name)));
  std::string line;
  std::getline(lines, line);  // header: strain, time, step_size, sxx, syy, szz, syz, szx, sxy, ...
  while (std::getline(lines, line)) {
    std::array<double, 9> v{};
    const char* at = line.data();
    const char* const end = at + line.size();
    for (double& x : v) {
      const auto [stop, error] = std::from_chars(at, end, x);
      if (error != std::errc{})
        throw core::InputError(in_folder(folder, macro_name) + ": a row is not numbers: " + line);
      at = stop < end ? stop + 1 : end;
    }
    const double a = v[3] - v[4], b = v[4] - v[5], c = v[5] - v[3];
    series.x.push_back(v[0]);
    series.y.push_back(
        std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (v[6] * v[6] + v[7] * v[7] + v[8] * v[8])));
  }
  return series;
}

/// The plots of the run with those of the Taylor model dashed over them.
std::vector<Plot> overlaid(std::vector<Plot> run, const std::vector<Plot>& taylor) {
  for (std::size_t i = 0; i < run.size(); ++i)
    for (Series s : taylor[i].series) {
      if (s.mark == Mark::line) s.mark = Mark::dashed;
      s.label = s.label.empty() ? "" : s.label + ", Taylor";
      run[i].series.push_back(std::move(s));
    }
  return run;
}

/// A plot a component, the run's curve and Taylor's.
std::vector<Plot> component_pairs(const Comparison& c) {
  std::vector<Plot> plots;
  const auto run = component_plots(c.run).front(), taylor = component_plots(c.taylor).front();
  for (std::size_t i = 0; i < run.series.size(); ++i) {
    Series mine = run.series[i], theirs = taylor.series[i];
    const std::string name = mine.label;
    mine.label = "run";
    theirs.label = "Taylor";
    if (theirs.mark == Mark::line) theirs.mark = Mark::dashed;
    plots.push_back({name, run.x, run.y, {mine, theirs}});
  }
  return plots;
}

void rename(std::vector<MapPanel>& panels, const std::string& whose) {
  for (MapPanel& p : panels) p.title = whose + ", " + p.title;
}

std::vector<MapPanel> pole_panels(const Analysis& a, const std::string& whose) {
  std::vector<MapPanel> panels;
  const Sample sample = a.texture_sample(a.samples.size() - 1);
  for (const auto& hkl : {std::array{1, 1, 1}, std::array{2, 0, 0}, std::array{2, 2, 0}})
    panels.push_back(pole_figure_panel(
        disc_grid(PoleFigure(sample, hkl, a.options.half_width, a.options.symmetry), 61,
                  a.options.threads),
        fmt::format("{{{}{}{}}}", hkl[0], hkl[1], hkl[2])));
  rename(panels, whose);
  return panels;
}

std::vector<MapPanel> section_panels(const Analysis& a, const std::string& whose) {
  const Odf odf(a.texture_sample(a.samples.size() - 1), a.options.half_width, a.options.symmetry);
  auto panels = rodrigues_panels(rodrigues_sections(odf, 33, a.options.threads));
  rename(panels, whose);
  return panels;
}

std::vector<MapPanel> joined(std::vector<MapPanel> first, const std::vector<MapPanel>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

std::vector<double> common_strains(const std::string& run, const std::string& taylor,
                                   const std::vector<double>& asked) {
  const auto theirs = stored_strains(taylor);
  std::vector<double> common;
  for (const double strain : stored_strains(run))
    if (holds(theirs, strain) && (asked.empty() || holds(asked, strain))) common.push_back(strain);
  if (common.empty())
    throw core::InputError(
        fmt::format("{} and {}: have stored no state at {} strain; give both decks the same "
                    "[output] at_strains",
                    run, taylor, asked.empty() ? "the same" : "such a"));
  return common;
}

Comparison compare_folders(const std::string& run, const std::string& taylor,
                           AnalysisOptions options) {
  options.at_strains = common_strains(run, taylor, options.at_strains);
  Comparison c{analyse_folder(run, options), {}};
  options.inner = options.one_mode = false;
  c.taylor = analyse_folder(taylor, options);
  return c;
}

std::string comparison_csv(const Comparison& c) {
  std::string text =
      "strain,component,intensity_run,intensity_taylor,volume_fraction_run,"
      "volume_fraction_taylor\n";
  for (std::size_t i = 0; i < c.run.textures.size(); ++i)
    for (std::size_t k = 0; k < c.run.textures[i].components.size(); ++k) {
      const auto &r = c.run.textures[i].components[k], &t = c.taylor.textures[i].components[k];
      text += fmt::format("{},{},{},{},{},{}\n", c.run.textures[i].strain, r.name, r.intensity,
                          t.intensity, r.volume_fraction, t.volume_fraction);
    }
  return text;
}

void check_comparison_place(const std::string& folder, bool overwrite) {
  const std::string path = in_folder(in_folder(folder, analysis_folder), table_name);
  if (!overwrite && std::filesystem::exists(path))
    throw core::InputError(path +
                           ": is an earlier comparison; give another folder with --to, or "
                           "replace it with --overwrite");
}

std::vector<std::string> write_comparison(const std::string& folder, const Comparison& c,
                                          const std::string& run, const std::string& taylor,
                                          bool overwrite) {
  check_comparison_place(folder, overwrite);
  const std::string to = in_folder(folder, analysis_folder);
  core::make_folder(to);
  std::vector<std::string> names;
  const auto put = [&](const std::string& name, const std::string& text) {
    core::write_file(in_folder(to, name), text);
    names.push_back(in_folder(analysis_folder, name));
  };
  const std::string at = fmt::format("strain {:.4g}", c.run.textures.back().strain);
  put(table_name, comparison_csv(c));
  put("compare-components.svg",
      svg_text(component_pairs(c), "Texture components of the run and of the Taylor model"));
  put("compare-beta-fibre.svg", svg_text(overlaid(beta_plots(c.run), beta_plots(c.taylor)),
                                         "The beta-fibre of the run and of the Taylor model"));
  put("compare-pole-figures.svg",
      map_svg(joined(pole_panels(c.run, "run"), pole_panels(c.taylor, "Taylor")), 3,
              "Pole figures at " + at));
  put("compare-odf-rodrigues.svg",
      map_svg(joined(section_panels(c.run, "run"), section_panels(c.taylor, "Taylor")), 7,
              "Sections of Rodrigues space at " + at));
  put("compare-stress.svg",
      svg_text(
          {{"Stress",
            {"strain"},
            {"von Mises stress (MPa)"},
            {stress_curve(run, "run", Mark::line), stress_curve(taylor, "Taylor", Mark::dashed)}}},
          "Stress of the run and of the Taylor model"));
  return names;
}

}  // namespace polyslip::results::analysis
