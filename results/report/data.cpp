#include "results/report/data.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "core/version.hpp"
#include "results/names.hpp"
#include "results/report/encode.hpp"
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
  blocks.push_back(
      {d.block, base64(gzip(state_block(surface, snapshot.mesh, box, values, d.ranges)))});
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

}  // namespace

ReportData gather(const std::string& folder) {
  const StateSeries series(folder);
  if (series.states().empty())
    throw core::InputError(folder + ": holds no stored states; give the folder of a polyslip run");
  ReportData data;
  data.title = fs::weakly_canonical(folder).filename().string();
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
      data.blocks.push_back({data.states.back().mesh_block, base64(gzip(mesh_block(surface)))});
    data.provenance = provenance_of(snapshot);
  }
  return data;
}

std::string json_text(const ReportData& data) {
  Json quantity_list = Json::array();
  for (const Quantity& q : quantities())
    quantity_list.push_back({{"name", q.name}, {"label", q.label}, {"unit", q.unit}});
  Json macro = Json::object(), states = Json::array(), provenance = Json::object();
  for (std::size_t i = 0; i < data.macro.names.size(); ++i)
    macro[data.macro.names[i]] = data.macro.columns[i];
  for (const auto& state : data.states) states.push_back(json_of(state));
  for (const auto& [name, text] : data.provenance) provenance[name] = text;
  const Json json = {{"schema", "polyslip-report/1"},
                     {"title", data.title},
                     {"version", core::version()},
                     {"summary", data.summary.empty() ? Json() : Json::parse(data.summary)},
                     {"macro", macro},
                     {"quantities", quantity_list},
                     {"states", states},
                     {"deck", data.deck},
                     {"resolved_deck", data.resolved_deck},
                     {"provenance", provenance}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace polyslip::results::report
