#include "results/regularisation_record.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/names.hpp"

namespace polyslip::results {

using Json = nlohmann::ordered_json;

Json to_json(const RegularisationRecord& r) {
  return {{"deletions", r.deletions},
          {"short_edges_before", r.short_before},
          {"short_edges_after", r.short_after},
          {"max_flatness_fault", r.max_flatness_fault},
          {"volume_change_rms", r.volume_change_rms},
          {"volume_change_worst", r.volume_change_worst},
          {"worst_grain", r.worst_grain}};
}

void write_regularisation(const RegularisationRecord& r, const std::string& folder) {
  Json j = {{"schema", "polyslip-regularisation/1"}};
  j.update(to_json(r));
  core::write_file(in_folder(folder, regularisation_name), j.dump(1) + "\n");
}

std::optional<RegularisationRecord> read_regularisation(const std::string& folder) {
  const std::string path = in_folder(folder, regularisation_name);
  if (!std::filesystem::exists(path)) return {};
  try {
    const Json j = Json::parse(core::read_text(path));
    RegularisationRecord r;
    j.at("deletions").get_to(r.deletions);
    j.at("short_edges_before").get_to(r.short_before);
    j.at("short_edges_after").get_to(r.short_after);
    j.at("max_flatness_fault").get_to(r.max_flatness_fault);
    j.at("volume_change_rms").get_to(r.volume_change_rms);
    j.at("volume_change_worst").get_to(r.volume_change_worst);
    j.at("worst_grain").get_to(r.worst_grain);
    return r;
  } catch (const nlohmann::json::exception& error) {
    throw core::InputError(path + ": is not what polyslip writes: " + error.what());
  }
}

}  // namespace polyslip::results
