#include "results/summary.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "fabricated.hpp"

namespace polyslip {
namespace {

TEST(Summary, HoldsTheFieldsOfARun) {
  const tests::TemporaryFolder folder;
  results::Summary s;
  s.completed = true;
  s.final_strain = 0.6;
  s.grains = 30;
  s.elements_initial = 100;
  s.elements_final = 200;
  s.nodes_final = 300;
  s.steps = 40;
  s.step_cuts = 1;
  s.newton_iterations = 90;
  s.linear_iterations = 900;
  results::RemeshingSummary worn;
  worn.strain = 0.3;
  worn.elements_after = 200;
  worn.strain_to_reload = 0.004;
  worn.trigger = "worn elements";
  worn.attempts = 2;
  worn.copied_faces = 5;
  worn.after.slip = {0.3, 0.1, 0.9};
  s.remeshings = {worn, {}};
  s.failed_remeshings = {{0.4, "grain 7"}};
  s.stress_final_mpa = {{{1, 2, 3}, {2, 5, 6}, {3, 6, std::numeric_limits<double>::quiet_NaN()}}};
  s.cpu_s = {{"meshing", 1.5}};
  s.wall_s = 2;
  s.peak_rss_mb = 300;
  s.version = "0.1.0";
  s.seed = 18446744073709551615ULL;
  results::write_summary(folder / "summary.json", s);
  const auto j = nlohmann::json::parse(tests::slurp(folder / "summary.json"));
  EXPECT_EQ(j.at("schema"), "polyslip-summary/1");
  EXPECT_EQ(j.at("completed"), true);
  for (const char* name :
       {"final_strain", "grains", "elements_initial", "elements_final", "nodes_final", "steps",
        "step_cuts", "newton_iterations", "linear_iterations", "wall_s", "peak_rss_mb", "seed"})
    EXPECT_TRUE(j.at(name).is_number()) << name;
  EXPECT_EQ(j.at("seed"), 18446744073709551615ULL);
  EXPECT_EQ(j.at("remeshings").at(0).at("strain_to_reload"), 0.004);
  EXPECT_TRUE(j.at("remeshings").at(1).at("strain_to_reload").is_null());
  EXPECT_EQ(j.at("remeshings").at(0).at("elements_after"), 200);
  EXPECT_EQ(j.at("remeshings").at(0).at("trigger"), "worn elements");
  EXPECT_EQ(j.at("remeshings").at(0).at("attempts"), 2);
  EXPECT_EQ(j.at("remeshings").at(0).at("copied_faces"), 5);
  EXPECT_EQ(j.at("remeshings").at(0).at("after").at("slip").at(2), 0.9);
  EXPECT_TRUE(j.at("remeshings").at(0).at("reloaded_stress_ratio").is_null());
  EXPECT_EQ(j.at("failed_remeshings").at(0).at("reason"), "grain 7");
  EXPECT_EQ(j.at("stress_final_mpa").at(1).at(2), 6);
  EXPECT_TRUE(j.at("stress_final_mpa").at(2).at(2).is_null());
  EXPECT_EQ(j.at("cpu_s").at("meshing"), 1.5);
}

TEST(Summary, LeavesOutWhatDoesNotApply) {
  results::Summary s;
  s.elements_initial = 5;
  s.min_radius_ratio = 0.25;
  const auto j = nlohmann::json::parse(results::summary_text(s));
  EXPECT_EQ(j.at("min_radius_ratio"), 0.25);
  EXPECT_FALSE(j.contains("final_strain"));
  EXPECT_FALSE(j.contains("remeshings"));
}

}  // namespace
}  // namespace polyslip
