#include "results/summary.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::results {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> optional_from(const Json& j) {
  return j.is_null() ? std::nullopt : std::optional<double>(j.get<double>());
}

Json to_json(const RemeshedState& s) {
  return {{"mean_spread", s.mean_spread},
          {"g", s.g},
          {"slip", s.slip},
          {"elastic_energy", s.elastic_energy},
          {"volume", or_null(s.volume)},
          {"volume_at_zero_pressure", or_null(s.volume_at_zero_pressure)}};
}

RemeshedState state_from(const Json& j) {
  const auto optional = [&](const char* key) {
    return j.contains(key) ? optional_from(j.at(key)) : std::nullopt;
  };
  return {j.at("mean_spread"),    j.at("g"),          j.at("slip"),
          j.at("elastic_energy"), optional("volume"), optional("volume_at_zero_pressure")};
}

Json to_json(const RemeshingSummary& r) {
  return {{"strain", r.strain},
          {"trigger", r.trigger},
          {"reason", r.reason},
          {"attempts", r.attempts},
          {"elements_before", r.elements_before},
          {"elements_after", r.elements_after},
          {"min_radius_ratio_before", r.min_radius_ratio_before},
          {"min_radius_ratio_after", r.min_radius_ratio_after},
          {"copied_faces", r.copied_faces},
          {"max_grain_volume_change", r.max_grain_volume_change},
          {"rms_grain_volume_change", r.rms_grain_volume_change},
          {"mean_grain_rotation", r.mean_grain_rotation},
          {"max_grain_rotation", r.max_grain_rotation},
          {"max_spread_change", r.max_spread_change},
          {"before", to_json(r.before)},
          {"after", to_json(r.after)},
          {"stress_before", r.stress_before},
          {"strain_to_reload", or_null(r.strain_to_reload)},
          {"reloaded_stress_ratio", or_null(r.reloaded_stress_ratio)}};
}

RemeshingSummary remeshing_from(const Json& j) {
  RemeshingSummary r;
  j.at("strain").get_to(r.strain);
  j.at("trigger").get_to(r.trigger);
  j.at("reason").get_to(r.reason);
  j.at("attempts").get_to(r.attempts);
  j.at("elements_before").get_to(r.elements_before);
  j.at("elements_after").get_to(r.elements_after);
  j.at("min_radius_ratio_before").get_to(r.min_radius_ratio_before);
  j.at("min_radius_ratio_after").get_to(r.min_radius_ratio_after);
  j.at("copied_faces").get_to(r.copied_faces);
  j.at("max_grain_volume_change").get_to(r.max_grain_volume_change);
  j.at("rms_grain_volume_change").get_to(r.rms_grain_volume_change);
  j.at("mean_grain_rotation").get_to(r.mean_grain_rotation);
  j.at("max_grain_rotation").get_to(r.max_grain_rotation);
  j.at("max_spread_change").get_to(r.max_spread_change);
  r.before = state_from(j.at("before"));
  r.after = state_from(j.at("after"));
  j.at("stress_before").get_to(r.stress_before);
  r.strain_to_reload = optional_from(j.at("strain_to_reload"));
  r.reloaded_stress_ratio = optional_from(j.at("reloaded_stress_ratio"));
  return r;
}

template <class T>
void add(Json& json, const char* name, const std::optional<T>& value) {
  if (value) json[name] = *value;
}

}  // namespace

std::string remeshing_text(const RemeshingSummary& remeshing) { return to_json(remeshing).dump(); }

RemeshingSummary remeshing_from_text(const std::string& text) {
  try {
    return remeshing_from(Json::parse(text));
  } catch (const nlohmann::json::exception& e) {
    throw core::InternalError(std::string("a remeshing in the summary: ") + e.what());
  }
}

std::string summary_text(const Summary& s) {
  Json j = {{"schema", "polyslip-summary/1"}};
  add(j, "completed", s.completed);
  add(j, "final_strain", s.final_strain);
  add(j, "grains", s.grains);
  add(j, "elements_initial", s.elements_initial);
  add(j, "elements_final", s.elements_final);
  add(j, "nodes_initial", s.nodes_initial);
  add(j, "nodes_final", s.nodes_final);
  add(j, "min_radius_ratio", s.min_radius_ratio);
  add(j, "mean_radius_ratio", s.mean_radius_ratio);
  add(j, "steps", s.steps);
  add(j, "step_cuts", s.step_cuts);
  add(j, "newton_iterations", s.newton_iterations);
  add(j, "linear_iterations", s.linear_iterations);
  if (s.remeshings) {
    j["remeshings"] = Json::array();
    for (const auto& r : *s.remeshings) j["remeshings"].push_back(to_json(r));
  }
  if (s.failed_remeshings) {
    j["failed_remeshings"] = Json::array();
    for (const auto& f : *s.failed_remeshings)
      j["failed_remeshings"].push_back({{"strain", f.strain}, {"reason", f.reason}});
  }
  add(j, "stress_final_mpa", s.stress_final_mpa);
  j["cpu_s"] = Json::object();
  for (const auto& [stage, seconds] : s.cpu_s) j["cpu_s"][stage] = seconds;
  add(j, "wall_s", s.wall_s);
  add(j, "peak_rss_mb", s.peak_rss_mb);
  j["version"] = s.version;
  add(j, "seed", s.seed);
  if (s.taylor)
    j["taylor"] = {{"initial_stress_over_g", s.taylor->initial_stress},
                   {"initial_slip_per_strain", s.taylor->initial_slip}};
  return j.dump(2) + "\n";
}

void write_summary(const std::string& path, const Summary& summary) {
  core::write_file(path, summary_text(summary));
}

}  // namespace polyslip::results
