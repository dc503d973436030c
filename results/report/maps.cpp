#include "results/report/maps.hpp"

#include <fmt/format.h>

#include "core/file.hpp"
#include "core/rotation.hpp"
#include "results/analysis/analysis_tables.hpp"
#include "results/analysis/map_figure.hpp"
#include "results/names.hpp"

namespace polyslip::results::report {
namespace {

constexpr std::array<std::array<int, 3>, 3> pole_families{{{1, 1, 1}, {2, 0, 0}, {2, 2, 0}}};
constexpr std::array<const char*, 3> pole_names{"111", "200", "220"};
constexpr std::array<const char*, 3> axis_names{"RD", "TD", "ND"};
constexpr int rodrigues_places = 25;  // a step of 0.035, two fifths of a half-width of 10 degrees

Sections sections_of(const analysis::Odf& odf, int threads) {
  Sections s;
  const double last = odf.symmetry() == analysis::SampleSymmetry::orthorhombic ? 90 : 360;
  s.n1 = 1 + static_cast<int>(last / s.step);
  s.n = 1 + static_cast<int>(90 / s.step);
  std::vector<core::Quaternion> places;
  for (const double phi2 : Sections::phi2)
    for (int j = 0; j < s.n; ++j)
      for (int i = 0; i < s.n1; ++i)
        places.push_back(core::from_bunge({i * s.step, j * s.step, phi2}));
  s.density = odf.at(places, threads);
  return s;
}

std::string section_csv(const Sections& s) {
  std::string text = "phi1,Phi,phi2,density\n";
  std::size_t at = 0;
  for (const double phi2 : Sections::phi2)
    for (int j = 0; j < s.n; ++j)
      for (int i = 0; i < s.n1; ++i)
        text += fmt::format("{},{},{},{}\n", i * s.step, j * s.step, phi2, s.density[at++]);
  return text;
}

/// phi1 to the right, Phi downwards.
std::vector<analysis::MapPanel> section_panels(const Sections& s) {
  std::vector<analysis::MapPanel> panels;
  for (std::size_t k = 0; k < Sections::phi2.size(); ++k) {
    analysis::MapPanel panel;
    panel.title = fmt::format("phi2 = {}", Sections::phi2[k]);
    panel.columns = s.n1;
    panel.rows = s.n;
    panel.high = {s.step * (s.n1 - 1), s.step * (s.n - 1)};
    for (int j = s.n - 1; j >= 0; --j) {
      const auto row = s.density.begin() + (static_cast<long>(k) * s.n + j) * s.n1;
      panel.values.insert(panel.values.end(), row, row + s.n1);
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

StateMaps maps_of(const analysis::Sample& sample, const analysis::AnalysisOptions& o) {
  StateMaps maps;
  for (std::size_t k = 0; k < 3; ++k) {
    maps.poles[k] = analysis::disc_grid(
        analysis::PoleFigure(sample, pole_families[k], o.half_width, o.symmetry), 61, o.threads);
    maps.inverse[k] = analysis::triangle_grid(
        analysis::InversePoleFigure(sample, core::Vec3::Unit(static_cast<int>(k)), o.half_width,
                                    o.symmetry),
        59, o.threads);
  }
  const analysis::Odf odf(sample, o.half_width, o.symmetry);
  maps.sections = sections_of(odf, o.threads);
  maps.rodrigues = analysis::rodrigues_sections(odf, rodrigues_places, o.threads);
  return maps;
}

std::vector<std::string> write_maps(const std::string& folder, const StateMaps& maps,
                                    double strain) {
  const std::string at = fmt::format("{:.4g}", strain);
  std::string pole_rows = analysis::pole_figure_header, inverse_rows = pole_rows;
  std::vector<analysis::MapPanel> poles, inverse;
  for (std::size_t k = 0; k < 3; ++k) {
    pole_rows += analysis::pole_figure_rows(maps.poles[k], pole_names[k]);
    inverse_rows += analysis::inverse_pole_figure_rows(maps.inverse[k], axis_names[k]);
    poles.push_back(
        analysis::pole_figure_panel(maps.poles[k], fmt::format("{{{}}}", pole_names[k])));
    inverse.push_back(analysis::inverse_pole_figure_panel(maps.inverse[k], axis_names[k]));
  }
  std::vector<std::string> names;
  const auto put = [&](const std::string& stem, const std::string& svg, const std::string& csv) {
    for (const auto& [extension, text] : {std::pair{".svg", svg}, std::pair{".csv", csv}}) {
      names.push_back(stem + at + extension);
      core::write_file(in_folder(folder, names.back()), text);
    }
  };
  put("pole-figures-", analysis::map_svg(poles, 3, "Pole figures at strain " + at), pole_rows);
  put("inverse-pole-figures-",
      analysis::map_svg(inverse, 3, "Inverse pole figures at strain " + at), inverse_rows);
  put("odf-sections-",
      analysis::map_svg(section_panels(maps.sections), 3,
                        "Sections of the ODF across phi2 at strain " + at),
      section_csv(maps.sections));
  put("odf-rodrigues-",
      analysis::map_svg(analysis::rodrigues_panels(maps.rodrigues), 4,
                        "Sections of the ODF in Rodrigues space at strain " + at),
      analysis::rodrigues_csv(maps.rodrigues));
  return names;
}

}  // namespace polyslip::results::report
