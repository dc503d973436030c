#include "drivers/run_progress.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.hpp"

namespace polyslip::drivers {
namespace {

using nlohmann::json;

}  // namespace

void RunProgress::add(const solver::StepRecord& step) {
  ++rows;
  add_attempts(step);
  const double now = von_mises(step.stress);
  if (step.step_size > 0) slope = (now - von_mises(stress)) / step.step_size;
  stress = step.stress;
  just_remeshed = false;
  const auto reloaded = reload.step(step.strain, now);
  if (reloaded.strain) remeshings.back().strain_to_reload = reloaded.strain;
  if (reloaded.ratio) remeshings.back().reloaded_stress_ratio = reloaded.ratio;
}

void RunProgress::add_attempts(const solver::StepRecord& tried) {
  cuts += tried.cuts;
  newton_iterations += tried.newton_iterations;
  linear_iterations += tried.linear_iterations;
}

void RunProgress::go_back(RunProgress before) {
  before.cuts = cuts;
  before.newton_iterations = newton_iterations;
  before.linear_iterations = linear_iterations;
  *this = std::move(before);
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
         {"slope", slope},
         {"due", {due.trigger, due.reason}},
         {"fresh", {fresh.worst_radius_ratio, fresh.poor_share, fresh.worst_jacobian}},
         {"sizes", std::vector<double>(sizes.data(), sizes.data() + sizes.size())},
         {"watch_from", watch_from},
         {"last_stored", last_stored},
         {"last_attempt", last_attempt},
         {"cpu_s", cpu_s},
         {"wall_s", wall_s},
         {"reload",
          {{"active", reload.state.active},
           {"ratio_due", reload.state.ratio_due},
           {"slope", reload.state.slope},
           {"before", reload.state.before},
           {"start_strain", reload.state.start_strain},
           {"target", reload.state.target},
           {"last_strain", reload.state.last_strain},
           {"last_stress", reload.state.last_stress}}},
         {"remeshings", json::array()},
         {"failed_remeshings", json::array()}};
  for (const auto& f : failed_remeshings)
    j["failed_remeshings"].push_back({{"strain", f.strain}, {"reason", f.reason}});
  for (const auto& r : remeshings) j["remeshings"].push_back(results::remeshing_text(r));
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
    j.at("slope").get_to(p.slope);
    j.at("cpu_s").get_to(p.cpu_s);
    j.at("wall_s").get_to(p.wall_s);
    j.at("due").at(0).get_to(p.due.trigger);
    j.at("due").at(1).get_to(p.due.reason);
    j.at("fresh").at(0).get_to(p.fresh.worst_radius_ratio);
    j.at("fresh").at(1).get_to(p.fresh.poor_share);
    j.at("fresh").at(2).get_to(p.fresh.worst_jacobian);
    if (j.contains("sizes"))  // checkpoints before it took the frame scaled back to isotropy
      p.sizes = core::Mat3(j.at("sizes").get<std::array<double, 9>>().data());
    j.at("watch_from").get_to(p.watch_from);
    j.at("last_stored").get_to(p.last_stored);
    j.at("last_attempt").get_to(p.last_attempt);
    for (const json& f : j.at("failed_remeshings"))
      p.failed_remeshings.push_back({f.at("strain"), f.at("reason")});
    const json& r = j.at("reload");
    r.at("active").get_to(p.reload.state.active);
    r.at("ratio_due").get_to(p.reload.state.ratio_due);
    r.at("slope").get_to(p.reload.state.slope);
    r.at("before").get_to(p.reload.state.before);
    r.at("start_strain").get_to(p.reload.state.start_strain);
    r.at("target").get_to(p.reload.state.target);
    r.at("last_strain").get_to(p.reload.state.last_strain);
    r.at("last_stress").get_to(p.reload.state.last_stress);
    for (const json& remeshing : j.at("remeshings"))
      p.remeshings.push_back(results::remeshing_from_text(remeshing.get<std::string>()));
    return p;
  } catch (const json::exception& e) {
    throw core::InternalError(std::string("progress of the run in a checkpoint: ") + e.what());
  }
}

}  // namespace polyslip::drivers
