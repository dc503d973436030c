#include "drivers/run_progress.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace polyslip::drivers {
namespace {

results::RemeshingSummary remeshing(double strain, const std::string& trigger, int attempts) {
  results::RemeshingSummary r;
  r.strain = strain;
  r.trigger = trigger;
  r.attempts = attempts;
  r.before.g = {10.1, 8.2, 11.9};
  return r;
}

TEST(RunProgress, CountsStepsAndTheReloading) {
  RunProgress p;
  p.just_remeshed = true;
  p.remeshings.push_back(remeshing(0.3, at_strains, 1));
  p.reload.start(0.3, 20, 50);
  solver::StepRecord step;
  step.strain = 0.302;
  step.step_size = 0.002;
  step.stress = {0, 0, -40, 0, 0, 0};
  step.newton_iterations = 3;
  step.linear_iterations = 17;
  step.cuts = 1;
  p.add(step);
  EXPECT_EQ(p.rows, 1);
  EXPECT_EQ(p.cuts, 1);
  EXPECT_EQ(p.newton_iterations, 3);
  EXPECT_EQ(p.linear_iterations, 17);
  EXPECT_FALSE(p.just_remeshed);
  ASSERT_TRUE(p.remeshings[0].strain_to_reload);
  EXPECT_NEAR(*p.remeshings[0].strain_to_reload, 0.002 * 0.99 / 2, 1e-12);
}

TEST(RunProgress, KeepsTheCountOfAttemptsInVain) {
  RunProgress p;
  p.rows = 7;
  p.cuts = 2;
  const RunProgress before = p;
  solver::StepRecord tried;
  tried.cuts = 5;
  tried.newton_iterations = 40;
  tried.linear_iterations = 300;
  p.rows = 8;
  p.add_attempts(tried);
  p.go_back(before);
  EXPECT_EQ(p.rows, 7);
  EXPECT_EQ(p.cuts, 7);
  EXPECT_EQ(p.newton_iterations, 40);
  EXPECT_EQ(p.linear_iterations, 300);
}

TEST(RunProgress, ComesBackFromItsText) {
  RunProgress p;
  p.rows = 41;
  p.states = 5;
  p.checkpoints = 3;
  p.cuts = 2;
  p.newton_iterations = 90;
  p.linear_iterations = 700;
  p.elements_initial = 3456;
  p.just_remeshed = true;
  p.stress = {0.1, 1.0 / 3, -27.123456789012345, 0, 1e-17, 2};
  p.remeshings.push_back(remeshing(0.3, at_strains, 1));
  p.remeshings.back().strain_to_reload = 0.0021;
  p.remeshings.back().reloaded_stress_ratio = 0.99999999999999989;
  p.remeshings.push_back(remeshing(0.5, worn_out, 3));
  p.failed_remeshings.push_back({0.4, "grain 3"});
  p.due = {failed_step, "no step"};
  p.fresh = {0.2, 0.01, 0.7, 0};
  p.sizes << 1.0 / 3, 0, 0.1, 0, 1, 0, 0, -0.2, 3;
  p.watch_from = 0.55;
  p.last_attempt = 0.5;
  p.last_stored = 0.48;
  p.slope = 41.5;
  p.reload.start(0.5, 31.7, 41.5);
  p.cpu_s = {{"meshing", 1.25}, {"deformation", 17.5}};
  p.wall_s = 12.5;
  const RunProgress q = RunProgress::from_text(p.text());
  EXPECT_EQ(q.text(), p.text());
  EXPECT_EQ(q.stress, p.stress);
  EXPECT_EQ(q.rows, 41);
  EXPECT_TRUE(q.reload.state.active);
  ASSERT_EQ(q.remeshings.size(), 2u);
  EXPECT_EQ(*q.remeshings[0].strain_to_reload, 0.0021);
  EXPECT_EQ(*q.remeshings[0].reloaded_stress_ratio, 0.99999999999999989);
  EXPECT_EQ(q.remeshings[0].before.g[2], 11.9);
  EXPECT_EQ(q.slope, 41.5);
  EXPECT_EQ(q.remeshings[1].trigger, worn_out);
  EXPECT_EQ(q.remeshings[1].attempts, 3);
  ASSERT_EQ(q.failed_remeshings.size(), 1u);
  EXPECT_EQ(q.failed_remeshings[0].reason, "grain 3");
  EXPECT_EQ(q.due.reason, "no step");
  EXPECT_EQ(q.fresh.worst_jacobian, 0.7);
  EXPECT_EQ(q.sizes, p.sizes);
  EXPECT_EQ(q.watch_from, 0.55);
  EXPECT_FALSE(q.remeshings[1].strain_to_reload);
}

TEST(RunProgress, RefusesOtherText) {
  EXPECT_THROW(RunProgress::from_text("{}"), core::InternalError);
  EXPECT_THROW(RunProgress::from_text("rows"), core::InternalError);
}

}  // namespace
}  // namespace polyslip::drivers
