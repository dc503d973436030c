#include "results/report/figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/file.hpp"
#include "results/analysis/analysis_figures.hpp"
#include "results/analysis/analysis_files.hpp"
#include "results/analysis/analysis_tables.hpp"
#include "results/names.hpp"
#include "results/plot.hpp"

namespace polyslip::results::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

std::string csv(const Columns& columns) {
  std::vector<std::string> names;
  for (const auto& [name, values] : columns) names.push_back(name);
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (std::size_t row = 0; row < columns.front().second.size(); ++row)
    for (std::size_t i = 0; i < columns.size(); ++i)
      text += fmt::format("{}{}", columns[i].second[row], i + 1 < columns.size() ? ',' : '\n');
  return text;
}

struct Figure {
  std::string name, caption;
  std::vector<Plot> panels;
  Columns columns;
};

std::vector<double> von_mises_of(const MacroTable& macro) {
  std::array<const std::vector<double>*, 6> s{};
  const std::array<const char*, 6> names{"sxx", "syy", "szz", "syz", "szx", "sxy"};
  for (std::size_t i = 0; i < 6; ++i) s[i] = &macro.column(names[i]);
  std::vector<double> result;
  for (std::size_t row = 0; row < macro.steps(); ++row) {
    core::Vec6 stress;
    for (int i = 0; i < 6; ++i) stress[i] = (*s[i])[row];
    result.push_back(von_mises(stress));
  }
  return result;
}

/// A curve in pieces, from zero at the start and after each remeshing.
Series pieces(const MacroTable& macro, const std::vector<double>& stress, const char* label) {
  const auto& strain = macro.column("strain");
  const auto& remeshed = macro.column("remeshed");
  Series s{.label = label, .mark = Mark::line, .x = {0}, .y = {0}};
  for (std::size_t i = 0; i < macro.steps(); ++i) {
    if (remeshed[i] != 0) {
      const double before = i > 0 ? strain[i - 1] : 0;
      s.x.insert(s.x.end(), {before, before});
      s.y.insert(s.y.end(), {nan, 0});
    }
    s.x.push_back(strain[i]);
    s.y.push_back(stress[i]);
  }
  return s;
}

Figure stress_strain(const MacroTable& macro) {
  const auto &load = macro.column("load_stress"), mises = von_mises_of(macro);
  Figure f{"stress-strain", "Stress against strain", {}, {}};
  f.panels.push_back(
      {.title = "Mean stress",
       .x = {.label = "strain", .from = 0.0},
       .y = {.label = "stress (MPa)"},
       .series = {pieces(macro, load, "along the load"), pieces(macro, mises, "von Mises")}});
  f.columns = {{"strain", macro.column("strain")}, {"load_stress", load}, {"von_mises", mises}};
  for (const char* name : {"sxx", "syy", "szz", "syz", "szx", "sxy"})
    f.columns.emplace_back(name, macro.column(name));
  return f;
}

Figure steps(const MacroTable& macro) {
  const auto& strain = macro.column("strain");
  const auto& newton = macro.column("newton_iterations");
  const auto& linear = macro.column("linear_iterations");
  const auto& size = macro.column("step_size");
  const PlotAxis x{.label = "strain", .from = 0.0};
  Figure f{"steps", "Iterations and size of each step", {}, {}};
  f.panels = {{.title = "Iterations of each step",
               .x = x,
               .y = {.label = "iterations", .from = 0.0},
               .series = {{.label = "linear", .x = strain, .y = linear},
                          {.label = "Newton", .x = strain, .y = newton}}},
              {.title = "Step size",
               .x = x,
               .y = {.label = "increment of strain", .logarithmic = true},
               .series = {{.label = "", .x = strain, .y = size}}}};
  f.columns = {{"strain", strain},
               {"step_size", size},
               {"newton_iterations", newton},
               {"linear_iterations", linear}};
  return f;
}

Figure means(const std::vector<StateDigest>& states) {
  Figure f{"means", "Means by volume, and the band that holds 98 % of the elements", {}, {}};
  std::vector<double> strain, mesh;
  for (const auto& s : states) {
    strain.push_back(s.record.strain);
    mesh.push_back(s.record.mesh_number);
  }
  f.columns = {{"strain", strain}, {"mesh", mesh}};
  for (std::size_t k = 0; k < quantity_count; ++k) {
    const Quantity& q = quantities()[k];
    std::vector<double> mean, low, high;
    for (const auto& s : states) {
      mean.push_back(s.ranges[k].mean);
      low.push_back(s.ranges[k].low);
      high.push_back(s.ranges[k].high);
    }
    f.columns.emplace_back(q.name + "_mean", mean);
    f.columns.emplace_back(q.name + "_first_per_cent", low);
    f.columns.emplace_back(q.name + "_last_per_cent", high);
    if (std::none_of(mean.begin(), mean.end(), [](double m) { return std::isfinite(m); })) continue;
    f.panels.push_back(
        {.title = q.label,
         .x = {.label = "strain"},
         .y = {.label = q.unit.empty() ? q.label : q.label + " (" + q.unit + ")"},
         .series = {
             {.label = "mean", .x = strain, .y = mean},
             {.label = "first and last per cent", .mark = Mark::dashed, .x = strain, .y = low},
             {.label = "", .mark = Mark::dashed, .x = strain, .y = high}}});
  }
  return f;
}

/// First and last state, and both sides of each remeshing.
std::vector<const StateDigest*> sides_of_meshes(const std::vector<StateDigest>& states) {
  std::vector<const StateDigest*> chosen;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int mesh = states[i].record.mesh_number;
    if (i == 0 || i + 1 == states.size() || states[i - 1].record.mesh_number != mesh ||
        states[i + 1].record.mesh_number != mesh)
      chosen.push_back(&states[i]);
  }
  return chosen;
}

Figure mesh_quality(const std::vector<StateDigest>& states) {
  Figure f{"mesh-quality", "Radius ratios of the elements", {}, {}};
  Plot plot{.title = "Radius ratios of the elements",
            .x = {.label = "radius ratio", .from = 0.0, .to = 1.0},
            .y = {.label = "density", .from = 0.0},
            .series = {}};
  std::vector<double> from;
  for (std::size_t i = 0; i < states.front().quality.counts.size(); ++i)
    from.push_back(states.front().quality.edge(static_cast<int>(i)));
  f.columns = {{"radius_ratio_from", from}};
  for (const StateDigest* s : sides_of_meshes(states)) {
    const std::string label =
        fmt::format("strain {:.4g}, mesh {}", s->record.strain, s->record.mesh_number + 1);
    plot.series.push_back(steps_of(s->quality, label));
    f.columns.emplace_back(
        fmt::format("strain {:.4g} mesh {}", s->record.strain, s->record.mesh_number + 1),
        s->quality.density());
  }
  f.panels = {plot};
  return f;
}

std::vector<std::string> write_textures(const std::string& folder, const Texture& texture) {
  const analysis::Analysis& a = texture.analysis;
  std::vector<std::string> names;
  const auto put = [&](std::string_view name, const std::string& text) {
    names.emplace_back(name);
    core::write_file(in_folder(folder, name), text);
  };
  const auto plot = [&](const char* name, const std::vector<Plot>& panels, const char* caption) {
    if (!panels.empty() && !panels.front().series.empty()) put(name, svg_text(panels, caption));
  };
  put(texture_name, analysis::texture_csv(a));
  put("texture-index.csv", analysis::index_csv(a));
  put("beta-fibre.csv", analysis::beta_csv(a));
  put(spreads_name, analysis::spreads_csv(a));
  put("spread-summary.csv", analysis::spread_summary_csv(a));
  plot("components.svg", analysis::component_plots(a), "Texture components against strain");
  plot("beta-fibre.svg", analysis::beta_plots(a), "Intensity along the beta-fibre");
  plot("spread-distribution.svg", analysis::spread_plots(a), "Distribution of in-grain spreads");
  plot("spread-correlation.svg", analysis::correlation_plots(a),
       "In-grain spreads from strain to strain");
  if (!texture.grains.empty()) put("rotation-paths.svg", analysis::path_svg(a, texture.grains));
  for (const auto& picture : texture.grains)
    plot(fmt::format("grain-{}.svg", picture.grain + 1).c_str(), analysis::grain_plots(a, picture),
         "Orientations of a grain about their mean");
  for (std::size_t i = 0; i < texture.maps.size(); ++i) {
    const auto maps = write_maps(folder, texture.maps[i], a.textures[i].strain);
    names.insert(names.end(), maps.begin(), maps.end());
  }
  return names;
}

}  // namespace

std::vector<std::string> write_figures(const std::string& folder, const ReportData& data) {
  core::make_folder(folder);
  std::vector<Figure> figures{means(data.states), mesh_quality(data.states)};
  if (data.macro.steps() > 0) {
    figures.push_back(stress_strain(data.macro));
    figures.push_back(steps(data.macro));
  }
  std::vector<std::string> names;
  for (const Figure& f : figures) {
    write_svg(in_folder(folder, f.name + ".svg"), f.panels, f.caption);
    core::write_file(in_folder(folder, f.name + ".csv"), csv(f.columns));
    names.insert(names.end(), {f.name + ".svg", f.name + ".csv"});
  }
  const auto textures = write_textures(folder, data.texture);
  names.insert(names.end(), textures.begin(), textures.end());
  return names;
}

}  // namespace polyslip::results::report
