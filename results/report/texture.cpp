#include "results/report/texture.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/rotation.hpp"
#include "results/analysis/analysis_figures.hpp"

namespace polyslip::results::report {
namespace {

using Json = nlohmann::ordered_json;

void put(std::string& block, const std::vector<double>& densities) {
  for (const double density : densities) {
    const auto value = static_cast<float>(density);
    block.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

std::string block_of(const StateMaps& maps) {
  std::string block;
  for (const auto& grid : maps.poles) put(block, grid.density);
  for (const auto& grid : maps.inverse) put(block, grid.density);
  put(block, maps.sections.density);
  put(block, maps.rodrigues.density);
  return block;
}

Json json_of(const std::vector<analysis::Place>& places) {
  Json list = Json::array();
  for (const auto& place : places) list.push_back({place[0], place[1]});
  return list;
}

/// The sections' outlines, and where the components lie: [r1, r2, initial].
Json rodrigues_json(const analysis::RodriguesSections& sections) {
  Json outlines = Json::array(), marks = Json::array();
  const auto panels = analysis::rodrigues_panels(sections);
  for (const auto& panel : panels) {
    outlines.push_back(json_of(panel.outline));
    Json of_panel = Json::array();
    for (const auto& mark : panel.marks) of_panel.push_back({mark.at[0], mark.at[1], mark.label});
    marks.push_back(of_panel);
  }
  return {{"n", sections.n},
          {"r3", sections.r3},
          {"reach", panels.front().high[0]},
          {"outlines", outlines},
          {"marks", marks}};
}

Json grain_json(const analysis::GrainPicture& picture, const analysis::GrainSpread& last,
                std::vector<Block>& blocks) {
  std::string block;
  put(block, picture.poles.density);
  for (const auto& v : picture.deviations) put(block, {v[0], v[1], v[2]});
  blocks.push_back(make_block(fmt::format("grain-{:06}", picture.grain + 1), block));
  Json paths = Json::array();
  for (const auto& path : picture.paths) paths.push_back(json_of(path));
  return {{"grain", picture.grain + 1},
          {"rotation", last.rotation},
          {"spread", last.spread},
          {"paths", paths},
          {"disc", {{"n", picture.poles.n}, {"reach", analysis::DiscGrid::reach}}},
          {"elements", picture.deviations.size()},
          {"block", blocks.back().name}};
}

/// Sizes of the grids, the same at each state.
Json grids_json(const StateMaps& maps) {
  const auto& t = maps.inverse.front();
  return {{"disc", {{"n", maps.poles.front().n}, {"reach", analysis::DiscGrid::reach}}},
          {"triangle",
           {{"x", {t.x(0), t.x(t.nx - 1)}},
            {"y", {t.y(0), t.y(t.ny - 1)}},
            {"nx", t.nx},
            {"ny", t.ny}}},
          {"sections",
           {{"phi2", Sections::phi2},
            {"step", maps.sections.step},
            {"n1", maps.sections.n1},
            {"n", maps.sections.n}}},
          {"rodrigues", rodrigues_json(maps.rodrigues)}};
}

Json components_json(const analysis::TextureState& state) {
  Json list = Json::array();
  for (const auto& c : state.components)
    list.push_back(
        {{"name", c.name}, {"intensity", c.intensity}, {"volume_fraction", c.volume_fraction}});
  return list;
}

Json beta_json(const analysis::TextureState& state) {
  Json list = Json::array();
  for (const auto& p : state.beta)
    list.push_back({{"phi2", p.phi2}, {"ideal", p.ideal_intensity}, {"ridge", p.ridge_intensity}});
  return list;
}

}  // namespace

Texture texture_of(const analysis::Analysis& analysis) {
  Texture texture{analysis, {}, {}};
  for (std::size_t i = 0; i < analysis.textures.size(); ++i)
    texture.maps.push_back(maps_of(analysis.texture_sample(i), analysis.options));
  if (!analysis.spreads.empty() && analysis::has_spread(analysis, analysis.spreads.size() - 1))
    for (const int grain : analysis::drawn_grains(analysis, {}))
      texture.grains.push_back(analysis::grain_picture(analysis, grain));
  return texture;
}

Json texture_json(const Texture& texture, const std::string& name, std::vector<Block>& blocks) {
  const analysis::AnalysisOptions& options = texture.analysis.options;
  Json states = Json::array();
  for (std::size_t i = 0; i < texture.maps.size(); ++i) {
    const auto& t = texture.analysis.textures[i];
    blocks.push_back(make_block(fmt::format("{}-{:04}", name, i), block_of(texture.maps[i])));
    states.push_back({{"strain", t.strain},
                      {"orientations", t.orientations},
                      {"texture_index", t.integrals.texture_index},
                      {"components", components_json(t)},
                      {"beta", beta_json(t)},
                      {"block", blocks.back().name}});
  }
  return {{"half_width", options.half_width * core::degrees_per_radian},
          {"fraction_angle", options.fraction_angle * core::degrees_per_radian},
          {"sample_symmetry",
           options.symmetry == analysis::SampleSymmetry::none ? "none" : "orthorhombic"},
          {"grids", grids_json(texture.maps.front())},
          {"states", states}};
}

Json spreads_json(const Texture& texture, std::vector<Block>& blocks) {
  const analysis::Analysis& a = texture.analysis;
  Json states = Json::array();
  for (std::size_t i = 0; i < a.spreads.size(); ++i) {
    const auto& s = a.spread_summaries[i];
    Json spread = Json::array(), rotation = Json::array(), bimodality = Json::array();
    for (const auto& grain : a.spreads[i]) {
      spread.push_back(grain.spread);
      rotation.push_back(grain.rotation);
      bimodality.push_back(grain.bimodality);
    }
    states.push_back({{"strain", s.strain},
                      {"mean", s.mean},
                      {"deviation", s.deviation},
                      {"volume_mean", s.volume_mean},
                      {"correlation", s.correlation},
                      {"spread", spread},
                      {"rotation", rotation},
                      {"bimodality", bimodality}});
  }
  Json drawn = Json::array();
  for (const auto& picture : texture.grains)
    drawn.push_back(
        grain_json(picture, a.spreads.back()[static_cast<std::size_t>(picture.grain)], blocks));
  return {{"states", states},
          {"inner", a.samples.front().inner},
          {"one_mode_bound", analysis::one_mode_bound},
          {"drawn", drawn}};
}

}  // namespace polyslip::results::report
