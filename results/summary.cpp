#include "results/summary.hpp"

#include <nlohmann/json.hpp>

#include "core/file.hpp"

namespace polyslip::results {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const RemeshingSummary& r) {
  Json j = {{"strain", r.strain},
            {"elements_before", r.elements_before},
            {"elements_after", r.elements_after},
            {"min_radius_ratio_before", r.min_radius_ratio_before},
            {"min_radius_ratio_after", r.min_radius_ratio_after},
            {"max_grain_volume_change", r.max_grain_volume_change},
            {"strain_to_reload", nullptr},
            {"trigger", r.trigger},
            {"reason", r.reason},
            {"attempts", r.attempts},
            {"copied_faces", r.copied_faces}};
  if (r.strain_to_reload) j["strain_to_reload"] = *r.strain_to_reload;
  return j;
}

template <class T>
void add(Json& json, const char* name, const std::optional<T>& value) {
  if (value) json[name] = *value;
}

}  // namespace

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
  return j.dump(2) + "\n";
}

void write_summary(const std::string& path, const Summary& summary) {
  core::write_file(path, summary_text(summary));
}

}  // namespace polyslip::results
