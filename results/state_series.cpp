#include "results/state_series.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/names.hpp"
#include "results/state_file.hpp"

namespace polyslip::results {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* index_schema = "polyslip-index/1";

Json to_json(const StateRecord& s) {
  return {{"file", s.file},        {"strain", s.strain}, {"time", s.time},
          {"mesh", s.mesh_number}, {"order", s.order},   {"nodes", s.nodes},
          {"elements", s.elements}};
}

StateRecord from_json(const Json& j) {
  StateRecord s;
  j.at("file").get_to(s.file);
  j.at("strain").get_to(s.strain);
  j.at("time").get_to(s.time);
  j.at("mesh").get_to(s.mesh_number);
  j.at("order").get_to(s.order);
  j.at("nodes").get_to(s.nodes);
  j.at("elements").get_to(s.elements);
  return s;
}

std::string index_path(const std::string& folder) {
  return in_folder(in_folder(folder, results_folder), index_name);
}

std::vector<StateRecord> read_index(const std::string& path) {
  std::vector<StateRecord> states;
  if (!fs::exists(path)) return states;
  try {
    const Json index = Json::parse(core::read_text(path));
    if (index.at("schema") != index_schema)
      throw core::InputError(fmt::format("{}: is not a {} file", path, index_schema));
    for (const auto& state : index.at("states")) states.push_back(from_json(state));
  } catch (const nlohmann::json::exception& e) {
    throw core::InputError(fmt::format("{}: index of states is damaged ({})", path, e.what()));
  }
  return states;
}

}  // namespace

StateSeries::StateSeries(std::string run_folder)
    : folder_(std::move(run_folder)), states_(read_index(index_path(folder_))) {}

std::string StateSeries::path(const StateRecord& state) const {
  return in_folder(in_folder(folder_, results_folder), state.file);
}

void StateSeries::write_index() const {
  Json index = {{"schema", index_schema}, {"states", Json::array()}};
  for (const auto& state : states_) index["states"].push_back(to_json(state));
  core::write_file(index_path(folder_), index.dump(1) + "\n");
  if (!without_mesh()) core::write_file(in_folder(folder_, xdmf_name), xdmf_text(states_));
}

const StateRecord& StateSeries::store(const mesh::Snapshot& snapshot) {
  return store(snapshot, mesh::reader_of(snapshot));
}

const StateRecord& StateSeries::store(const mesh::Snapshot& snapshot,
                                      const mesh::FieldReader& read) {
  StateRecord state;
  state.file = state_name(static_cast<int>(states_.size()));
  state.strain = snapshot.strain;
  state.time = snapshot.time;
  state.mesh_number = snapshot.mesh_number;
  state.order = snapshot.mesh.order;
  state.nodes = snapshot.mesh.node_count();
  state.elements = snapshot.mesh.element_count();
  write_state(path(state), snapshot, read);
  states_.push_back(std::move(state));
  write_index();
  return states_.back();
}

const StateRecord& StateSeries::store(const OrientationState& orientations) {
  StateRecord state;
  state.file = state_name(static_cast<int>(states_.size()));
  state.strain = orientations.strain;
  state.time = orientations.time;
  state.mesh_number = no_mesh;
  state.order = 0;
  state.elements = static_cast<long>(orientations.table.volume.size());
  write_orientation_state(path(state), orientations);
  states_.push_back(std::move(state));
  write_index();
  return states_.back();
}

void StateSeries::require_first(std::size_t count) const {
  if (count > states_.size())
    throw core::InputError(
        fmt::format("{}: index names {} states where the checkpoint needs {}; run anew",
                    index_path(folder_), states_.size(), count));
  for (std::size_t i = 0; i < count; ++i)
    if (!fs::exists(path(states_[i])))
      throw core::InputError(
          fmt::format("{}: no such file; put it back or run anew", path(states_[i])));
}

void StateSeries::keep_first(std::size_t count) {
  require_first(count);
  states_.resize(count);
  write_index();
  std::vector<fs::path> late;
  for (const auto& entry : fs::directory_iterator(in_folder(folder_, results_folder))) {
    std::string name = entry.path().filename().string();
    const bool part = name.ends_with(".part");
    if (part) name.resize(name.size() - 5);
    const int number = state_number(name);
    if (number >= 0 && (part || number >= static_cast<int>(count))) late.push_back(entry.path());
  }
  for (const auto& path : late) fs::remove(path);
}

void StateSeries::trim_after(double strain) {
  std::size_t count = 0;
  while (count < states_.size() && states_[count].strain <= strain) ++count;
  keep_first(count);
}

StateSeries begun_series(const std::string& run_folder) {
  StateSeries series(run_folder);
  if (series.states().empty())
    throw core::InputError(run_folder +
                           ": holds no stored state; give the folder of a run that has begun");
  return series;
}

const StateRecord& nearest_state(const StateSeries& series, double strain) {
  const StateRecord* nearest = nullptr;
  for (const auto& state : series.states())
    if (nearest == nullptr || std::abs(state.strain - strain) < std::abs(nearest->strain - strain))
      nearest = &state;
  if (nearest == nullptr) throw core::InputError("the run has stored no state yet");
  return *nearest;
}

}  // namespace polyslip::results
