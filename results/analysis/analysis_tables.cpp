#include "results/analysis/analysis_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/rotation.hpp"

namespace polyslip::results::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json component_json(const ComponentValue& c) {
  return {
      {"component", c.name}, {"intensity", c.intensity}, {"volume_fraction", c.volume_fraction}};
}

Json fibre_json(const FibrePoint& p) {
  return {{"phi2", p.phi2},
          {"ideal", {p.ideal[0], p.ideal[1]}},
          {"ideal_intensity", p.ideal_intensity},
          {"ridge", {p.ridge[0], p.ridge[1]}},
          {"ridge_intensity", p.ridge_intensity}};
}

Json texture_json(const TextureState& t) {
  Json j = {{"strain", t.strain},          {"orientations", t.orientations},
            {"mean", t.integrals.mean},    {"texture_index", t.integrals.texture_index},
            {"components", Json::array()}, {"beta_fibre", Json::array()}};
  for (const auto& c : t.components) j["components"].push_back(component_json(c));
  for (const auto& p : t.beta) j["beta_fibre"].push_back(fibre_json(p));
  return j;
}

Json spread_json(const SpreadSummary& s) {
  return {
      {"strain", s.strain},       {"grains", s.grains},           {"mean", s.mean},
      {"deviation", s.deviation}, {"volume_mean", s.volume_mean}, {"correlation", s.correlation}};
}

constexpr const char* rodrigues_header = "r1,r2,r3,density\n";

/// Empty outside of the fundamental region.
std::string rodrigues_row(double r1, double r2, double r3, double density) {
  if (std::abs(r1) + std::abs(r2) + std::abs(r3) > 1 + 1e-9) return {};
  return fmt::format("{},{},{},{}\n", r1, r2, r3, density);
}

}  // namespace

std::string index_csv(const Analysis& a) {
  std::string text = "strain,orientations,mean,texture_index\n";
  for (const auto& t : a.textures)
    text += fmt::format("{},{},{},{}\n", t.strain, t.orientations, t.integrals.mean,
                        t.integrals.texture_index);
  return text;
}

std::string beta_csv(const Analysis& a) {
  std::string text =
      "strain,phi2,phi1_ideal,Phi_ideal,intensity_ideal,phi1_ridge,Phi_ridge,intensity_ridge\n";
  for (const auto& t : a.textures)
    for (const auto& p : t.beta)
      text += fmt::format("{},{},{},{},{},{},{},{}\n", t.strain, p.phi2, p.ideal[0], p.ideal[1],
                          p.ideal_intensity, p.ridge[0], p.ridge[1], p.ridge_intensity);
  return text;
}

std::string spreads_csv(const Analysis& a) {
  std::string text =
      "strain,grain,inner,counted,elements,volume,q0,q1,q2,q3,spread,deviation,largest,rotation,"
      "bimodality\n";
  for (std::size_t i = 0; i < a.spreads.size(); ++i)
    for (std::size_t g = 0; g < a.spreads[i].size(); ++g) {
      const GrainSpread& s = a.spreads[i][g];
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", a.samples[i].strain,
                          g + 1, a.samples[i].inner[g] ? 1 : 0, a.counted[g] ? 1 : 0, s.elements,
                          s.volume, s.mean.w(), s.mean.x(), s.mean.y(), s.mean.z(), s.spread,
                          s.deviation, s.largest, s.rotation, s.bimodality);
    }
  return text;
}

std::string spread_summary_csv(const Analysis& a) {
  std::string text = "strain,grains,mean,deviation,volume_mean,correlation\n";
  for (const auto& s : a.spread_summaries)
    text += fmt::format("{},{},{},{},{},{}\n", s.strain, s.grains, s.mean, s.deviation,
                        s.volume_mean, s.correlation);
  return text;
}

std::string bunge_csv(const BungeGrid& grid) {
  std::string text = "phi1,Phi,phi2,density\n";
  for (int k = 0; k < grid.n; ++k)
    for (int j = 0; j < grid.n; ++j)
      for (int i = 0; i < grid.n1; ++i)
        text += fmt::format("{},{},{},{}\n", i * grid.step, j * grid.step, k * grid.step,
                            grid.at(i, j, k));
  return text;
}

std::string rodrigues_csv(const RodriguesGrid& grid) {
  std::string text = rodrigues_header;
  for (int k = 0; k < grid.n; ++k)
    for (int j = 0; j < grid.n; ++j)
      for (int i = 0; i < grid.n; ++i)
        text += rodrigues_row(grid.place(i), grid.place(j), grid.place(k), grid.at(i, j, k));
  return text;
}

std::string rodrigues_csv(const RodriguesSections& sections) {
  const RodriguesGrid places{sections.n, {}};
  std::string text = rodrigues_header;
  std::size_t at = 0;
  for (const double r3 : sections.r3)
    for (int j = 0; j < sections.n; ++j)
      for (int i = 0; i < sections.n; ++i)
        text += rodrigues_row(places.place(i), places.place(j), r3, sections.density[at++]);
  return text;
}

std::string pole_figure_rows(const DiscGrid& grid, const std::string& figure) {
  std::string text;
  for (int j = 0; j < grid.n; ++j)
    for (int i = 0; i < grid.n; ++i)
      if (std::hypot(grid.place(i), grid.place(j)) <= 1)
        text += fmt::format("{},{},{},{}\n", figure, grid.place(i), grid.place(j),
                            grid.density[static_cast<std::size_t>(j * grid.n + i)]);
  return text;
}

std::string inverse_pole_figure_rows(const TriangleGrid& grid, const std::string& figure) {
  std::string text;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const core::Vec3 d = from_equal_area({grid.x(i), grid.y(j)});
      if ((in_standard_triangle(d) - d).norm() < 1e-9)
        text += fmt::format("{},{},{},{}\n", figure, grid.x(i), grid.y(j),
                            grid.density[static_cast<std::size_t>(j * grid.nx + i)]);
    }
  return text;
}

std::string analysis_json(const Analysis& a) {
  const double degrees = core::degrees_per_radian;
  Json j = {
      {"schema", "polyslip-analysis/1"},
      {"half_width_degrees", a.options.half_width * degrees},
      {"fraction_angle_degrees", a.options.fraction_angle * degrees},
      {"sample_symmetry", a.options.symmetry == SampleSymmetry::none ? "none" : "orthorhombic"},
      {"inner", a.options.inner},
      {"one_mode", a.options.one_mode},
      {"textures", Json::array()},
      {"spreads", Json::array()}};
  for (const auto& t : a.textures) j["textures"].push_back(texture_json(t));
  for (const auto& s : a.spread_summaries) j["spreads"].push_back(spread_json(s));
  return j.dump(1) + "\n";
}

}  // namespace polyslip::results::analysis
