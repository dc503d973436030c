#include "solver/load_program.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "solver/stress_search.hpp"

namespace polyslip::solver {
namespace {

TEST(LoadProgram, OneStageAtATrueRate) {
  LoadingOptions o;
  o.strain_rate = 2;
  o.final_strain = 0.6;
  LoadProgram p(o);
  EXPECT_EQ(p.planned_end(), 0.6);
  EXPECT_EQ(p.time(0.3), 0.15);
  EXPECT_EQ(p.strain(0.3), 0.3);
  EXPECT_FALSE(p.advance(0.3, false));
  EXPECT_TRUE(p.advance(0.6, false));
  EXPECT_TRUE(p.finished());
  EXPECT_DOUBLE_EQ(p.time(0.6), 0.3);
}

TEST(LoadProgram, AConstantVelocityStretchesLinearlyInTime) {
  for (const auto& [type, sign] : {std::pair{"uniaxial-tension", 1},
                                   {"uniaxial-compression", -1},
                                   {"plane-strain-compression", -1}}) {
    LoadingOptions o;
    o.type = type;
    o.control = "constant-velocity";
    o.strain_rate = 0.5;
    o.final_time = 0.6;
    const LoadProgram p(o);
    EXPECT_NEAR(p.planned_end(), std::abs(std::log(1 + sign * 0.5 * 0.6)), 1e-15) << type;
    EXPECT_NEAR(p.time(p.planned_end()), 0.6, 1e-14);
    const double e = 0.1;  // h/h0 = 1 +- rate t
    EXPECT_NEAR(1 + sign * 0.5 * p.time(e), std::exp(sign * e), 1e-14);
  }
}

TEST(LoadProgram, StagesJumpAndGoBack) {
  LoadingOptions o;
  o.stages = {{1, 0.1, {}, {}}, {10, 0.2, {}, {}}, {4, -0.1, {}, {}}, {-1, {}, 0.5, {}}};
  LoadProgram p(o);
  EXPECT_NEAR(p.planned_end(), 0.2 + 0.3 + 0.5 - 0.1 - 0.01 - 0.075, 1e-14);
  EXPECT_TRUE(p.advance(0.1, false));
  EXPECT_NEAR(p.time(0.15), 0.105, 1e-15);
  EXPECT_TRUE(p.advance(p.stage_end(), false));
  EXPECT_EQ(p.direction(), -1);
  EXPECT_NEAR(p.strain(0.25), 0.15, 1e-15);
  LoadProgram q(o);
  q.restore(p.history());
  EXPECT_EQ(q.time(0.25), p.time(0.25));
  EXPECT_EQ(q.stage_end(), p.stage_end());
  EXPECT_TRUE(p.advance(p.stage_end(), false));
  EXPECT_EQ(p.strain(p.stage_end()) < -0.1, true);
  EXPECT_THROW(q.restore({1, 2}), core::InternalError);
  EXPECT_THROW(q.restore({7, 0, 0, 0}), core::InternalError);
}

TEST(LoadProgram, AStressEndsAStageEarly) {
  LoadingOptions o;
  o.stages = {{1, 0.1, {}, 20.0}, {1, 0.02, {}, {}}};
  LoadProgram p(o);
  EXPECT_EQ(p.stress_target(), 20);
  EXPECT_TRUE(p.advance(0.05, true));
  EXPECT_EQ(p.direction(), -1);
  EXPECT_NEAR(p.stage_end(), 0.08, 1e-15);
}

TEST(LoadProgram, StressOfTheLoad) {
  const std::array<double, 6> s{1, 2, 3, 4, 5, 6};
  LoadingOptions o;
  EXPECT_EQ(load_stress(o, s), -3);
  o.type = "uniaxial-tension";
  o.axis = 1;
  EXPECT_EQ(load_stress(o, s), 2);
  o.type = "simple-shear";
  o.axis = 2;
  o.direction = 1;
  EXPECT_EQ(load_stress(o, s), 4);
  o.direction = 0;
  EXPECT_EQ(load_stress(o, s), 5);
  o.type = "faces";
  EXPECT_DOUBLE_EQ(load_stress(o, {0, 0, -7, 0, 0, 0}), 7);
  EXPECT_DOUBLE_EQ(load_stress(o, {5, 5, 5, 0, 0, 2}), 2 * std::sqrt(3));
}

TEST(StressSearch, MeetsItsTargetOnAStiffCurve) {
  LoadingOptions o;
  o.final_stress = 20;
  const LoadProgram p(o);
  const auto curve = [](double strain) { return 30 * (1 - std::exp(-strain / 1e-3)); };
  const double start = 1e-3;
  StressSearch search(p, curve(start));
  double increment = 5e-3;
  int trials = 0;
  while (search.goes_on(increment, curve(start + increment))) {
    increment = search.increment();
    ASSERT_LT(++trials, 15);
  }
  EXPECT_TRUE(search.met());
  EXPECT_NEAR(curve(start + increment), 20, 0.02);
}

TEST(StressSearch, LeavesStepsBeforeTheTargetAlone) {
  LoadingOptions o;
  o.final_stress = 20;
  const LoadProgram p(o);
  StressSearch search(p, 1);
  EXPECT_FALSE(search.goes_on(0.01, 15));
  EXPECT_FALSE(search.met());
}

}  // namespace
}  // namespace polyslip::solver
