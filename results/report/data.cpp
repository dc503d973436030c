#include "results/report/data.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "core/version.hpp"
#include "results/names.hpp"
#include "results/report/scene.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace polyslip::results::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_if_there(const std::string& path) {
  return fs::exists(path) ? core::read_text(path) : std::string();
}

/// Provenance of the last state: short texts only, decks and progress have places of their own.
std::vector<std::pair<std::string, std::string>> provenance_of(const mesh::Snapshot& snapshot) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const auto& [name, text] : snapshot.provenance)
    if (text.find('\n') == std::string::npos && text.size() < 200 && name != "progress")
      result.emplace_back(name, text);
  return result;
}

StateDigest digest(const mesh::Snapshot& snapshot, const StateRecord& record,
                   const Surface& surface, std::size_t number, std::vector<Block>& blocks) {
  StateValues values = values_of(snapshot);
  StateDigest d;
  d.record = record;
  d.mesh_block = numbered("mesh-", snapshot.mesh_number, 3, "");
  d.block = numbered("state-", static_cast<int>(number), 4, "");
  d.surface_nodes = surface.nodes.size();
  for (std::size_t k = 0; k < quantity_count; ++k)
    d.ranges[k] = range_of(values.values[k], values.volume);
  for (const double ratio : values.values.back()) d.quality.add(ratio);
  const Box box = box_of(surface, snapshot.mesh);
  d.box = {box.low, box.high};
  blocks.push_back(make_block(d.block, state_block(surface, snapshot.mesh, box, values, d.ranges)));
  d.grain_orientation = std::move(values.grain_orientation);
  d.grain_volume = std::move(values.grain_volume);
  return d;
}

Json json_of(const core::Vec3& v) { return {v[0], v[1], v[2]}; }

Json json_of(const StateDigest& s) {
  Json ranges = Json::object();
  for (std::size_t k = 0; k < quantity_count; ++k) {
    const Range& r = s.ranges[k];
    ranges[quantities()[k].name] = {
        {"min", r.min}, {"low", r.low}, {"mean", r.mean}, {"high", r.high}, {"max", r.max}};
  }
  Json bunge = Json::array();
  for (const auto& q : s.grain_orientation) bunge.push_back(json_of(core::to_bunge(q)));
  return {{"file", s.record.file},
          {"strain", s.record.strain},
          {"time", s.record.time},
          {"mesh", s.record.mesh_number},
          {"nodes", s.record.nodes},
          {"elements", s.record.elements},
          {"block", s.block},
          {"mesh_block", s.mesh_block},
          {"surface_nodes", s.surface_nodes},
          {"box", {json_of(s.box[0]), json_of(s.box[1])}},
          {"values", ranges},
          {"quality", s.quality.counts},
          {"grain_bunge", bunge},
          {"grain_volume", s.grain_volume}};
}

Json columns_of(const MacroTable& macro) {
  Json columns = Json::object();
  for (std::size_t i = 0; i < macro.names.size(); ++i) columns[macro.names[i]] = macro.columns[i];
  return columns;
}

std::string title_of(const std::string& folder) {
  return fs::weakly_canonical(folder).filename().string();
}

void add_textures(const Sources& sources, ReportData& data) {
  data.texture = texture_of(analysis::analyse_folder(sources.folder, sources.texture));
  data.texture_values = texture_json(data.texture, "texture", data.blocks);
  data.spreads = spreads_json(data.texture, data.blocks);
  if (sources.taylor.empty()) return;
  const Texture taylor = texture_of(analysis::analyse_folder(sources.taylor, sources.texture));
  data.taylor = {{"title", title_of(sources.taylor)},
                 {"macro", columns_of(read_macro(in_folder(sources.taylor, macro_name)))},
                 {"texture", texture_json(taylor, "taylor", data.blocks)}};
}

StateSeries states_of(const std::string& folder) {
  StateSeries series(folder);
  if (series.states().empty())
    throw core::InputError(folder + ": holds no stored states; give the folder of a polyslip run");
  if (series.without_mesh())
    throw core::InputError(folder +
                           ": is a Taylor model, which has no mesh to show; give it by --taylor "
                           "beside a run");
  return series;
}

}  // namespace

ReportData gather(const Sources& sources) {
  const std::string& folder = sources.folder;
  const StateSeries series = states_of(folder);
  ReportData data;
  data.title = title_of(folder);
  data.summary = text_if_there(in_folder(folder, summary_name));
  data.deck = text_if_there(in_folder(folder, deck_name));
  data.resolved_deck = text_if_there(in_folder(folder, resolved_deck_name));
  data.macro = read_macro(in_folder(folder, macro_name));
  Surface surface;
  for (const StateRecord& record : series.states()) {
    const mesh::Snapshot snapshot = read_state(series.path(record));
    const bool new_mesh =
        data.states.empty() || data.states.back().record.mesh_number != record.mesh_number;
    if (new_mesh) surface = surface_of(snapshot.mesh);
    data.states.push_back(digest(snapshot, record, surface, data.states.size(), data.blocks));
    if (new_mesh)
      data.blocks.push_back(make_block(data.states.back().mesh_block, mesh_block(surface)));
    data.provenance = provenance_of(snapshot);
  }
  add_textures(sources, data);
  return data;
}

std::string json_text(const ReportData& data) {
  Json quantity_list = Json::array();
  for (const Quantity& q : quantities())
    quantity_list.push_back({{"name", q.name}, {"label", q.label}, {"unit", q.unit}});
  Json states = Json::array(), provenance = Json::object();
  for (const auto& state : data.states) states.push_back(json_of(state));
  for (const auto& [name, text] : data.provenance) provenance[name] = text;
  const Json json = {{"schema", "polyslip-report/1"},
                     {"title", data.title},
                     {"version", core::version()},
                     {"summary", data.summary.empty() ? Json() : Json::parse(data.summary)},
                     {"macro", columns_of(data.macro)},
                     {"quantities", quantity_list},
                     {"states", states},
                     {"texture", data.texture_values},
                     {"spreads", data.spreads},
                     {"taylor", data.taylor},
                     {"deck", data.deck},
                     {"resolved_deck", data.resolved_deck},
                     {"provenance", provenance}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace polyslip::results::report
