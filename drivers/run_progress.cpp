#include "drivers/run_progress.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace polyslip::drivers {
namespace {

using nlohmann::json;

json to_json(const results::RemeshingSummary& r) {
  json j{{"strain", r.strain},
         {"elements_before", r.elements_before},
         {"elements_after", r.elements_after},
         {"min_radius_ratio_before", r.min_radius_ratio_before},
         {"min_radius_ratio_after", r.min_radius_ratio_after},
         {"max_grain_volume_change", r.max_grain_volume_change},
         {"trigger", r.trigger},
         {"reason", r.reason},
         {"attempts", r.attempts},
         {"copied_faces", r.copied_faces}};
  if (r.strain_to_reload) j["strain_to_reload"] = *r.strain_to_reload;
  return j;
}

results::RemeshingSummary remeshing_from(const json& j) {
  results::RemeshingSummary r;
  j.at("strain").get_to(r.strain);
  j.at("elements_before").get_to(r.elements_before);
  j.at("elements_after").get_to(r.elements_after);
  j.at("min_radius_ratio_before").get_to(r.min_radius_ratio_before);
  j.at("min_radius_ratio_after").get_to(r.min_radius_ratio_after);
  j.at("max_grain_volume_change").get_to(r.max_grain_volume_change);
  j.at("trigger").get_to(r.trigger);
  j.at("reason").get_to(r.reason);
  j.at("attempts").get_to(r.attempts);
  j.at("copied_faces").get_to(r.copied_faces);
  if (j.contains("strain_to_reload")) r.strain_to_reload = j.at("strain_to_reload").get<double>();
  return r;
}

}  // namespace

void RunProgress::add(const solver::StepRecord& step) {
  ++rows;
  cuts += step.cuts;
  newton_iterations += step.newton_iterations;
  linear_iterations += step.linear_iterations;
  stress = step.stress;
  just_remeshed = false;
  if (const auto strain = reload.step(step.strain, von_mises(step.stress)))
    remeshings.back().strain_to_reload = *strain;
}

std::string RunProgress::text() const {
  json j{{"rows", rows},
         {"states", states},
         {"checkpoints", checkpoints},
         {"cuts", cuts},
         {"newton_iterations", newton_iterations},
         {"linear_iterations", linear_iterations},
         {"elements_initial", elements_initial},
         {"just_remeshed", just_remeshed},
         {"stress", stress},
         {"due", {due.trigger, due.reason}},
         {"fresh", {fresh.worst_radius_ratio, fresh.poor_share, fresh.worst_jacobian}},
         {"watch_from", watch_from},
         {"last_stored", last_stored},
         {"last_attempt", last_attempt},
         {"cpu_s", cpu_s},
         {"wall_s", wall_s},
         {"reload",
          {{"active", reload.state.active},
           {"start_strain", reload.state.start_strain},
           {"target", reload.state.target},
           {"last_strain", reload.state.last_strain},
           {"last_stress", reload.state.last_stress}}},
         {"remeshings", json::array()},
         {"failed_remeshings", json::array()}};
  for (const auto& f : failed_remeshings)
    j["failed_remeshings"].push_back({{"strain", f.strain}, {"reason", f.reason}});
  for (const auto& r : remeshings) j["remeshings"].push_back(to_json(r));
  return j.dump();
}

RunProgress RunProgress::from_text(const std::string& text) {
  try {
    const json j = json::parse(text);
    RunProgress p;
    j.at("rows").get_to(p.rows);
    j.at("states").get_to(p.states);
    j.at("checkpoints").get_to(p.checkpoints);
    j.at("cuts").get_to(p.cuts);
    j.at("newton_iterations").get_to(p.newton_iterations);
    j.at("linear_iterations").get_to(p.linear_iterations);
    j.at("elements_initial").get_to(p.elements_initial);
    j.at("just_remeshed").get_to(p.just_remeshed);
    j.at("stress").get_to(p.stress);
    j.at("cpu_s").get_to(p.cpu_s);
    j.at("wall_s").get_to(p.wall_s);
    j.at("due").at(0).get_to(p.due.trigger);
    j.at("due").at(1).get_to(p.due.reason);
    j.at("fresh").at(0).get_to(p.fresh.worst_radius_ratio);
    j.at("fresh").at(1).get_to(p.fresh.poor_share);
    j.at("fresh").at(2).get_to(p.fresh.worst_jacobian);
    j.at("watch_from").get_to(p.watch_from);
    j.at("last_stored").get_to(p.last_stored);
    j.at("last_attempt").get_to(p.last_attempt);
    for (const json& f : j.at("failed_remeshings"))
      p.failed_remeshings.push_back({f.at("strain"), f.at("reason")});
    const json& r = j.at("reload");
    r.at("active").get_to(p.reload.state.active);
    r.at("start_strain").get_to(p.reload.state.start_strain);
    r.at("target").get_to(p.reload.state.target);
    r.at("last_strain").get_to(p.reload.state.last_strain);
    r.at("last_stress").get_to(p.reload.state.last_stress);
    for (const json& remeshing : j.at("remeshings"))
      p.remeshings.push_back(remeshing_from(remeshing));
    return p;
  } catch (const json::exception& e) {
    throw core::InternalError(std::string("progress of the run in a checkpoint: ") + e.what());
  }
}

}  // namespace polyslip::drivers
