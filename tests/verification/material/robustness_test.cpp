// Not one of 100,000 random steps may fail: orientations, stresses from zero to beyond flow and
// reversed, strain increments from 1e-6 to 0.08, at n = 8, 20, 50, 100 and 300
// (where a few of them need the continuation in the exponent).

#include <gtest/gtest.h>

#include "../../unit/material/random_points.hpp"

namespace {

using namespace polyslip;
using material::test::Batch;

class Robustness : public ::testing::TestWithParam<double> {};

TEST_P(Robustness, RandomStates) {
  material::MaterialOptions o;
  o.rate_sensitivity = 1 / GetParam();
  const auto law = material::make_fcc_law(o);
  Batch batch(*law, 20000);
  core::Random random(17, core::Stream::tests);
  material::test::randomise(batch, *law, o, random, 1e-6, 0.08);
  batch.run(*law);
  EXPECT_EQ(batch.failures(), 0);
  for (int p = 0; p < batch.points; ++p) {
    ASSERT_GE(batch.new_state(p, 9), batch.old_state(p, 9));
    ASSERT_LE(batch.new_state(p, 9), o.gs);
    ASSERT_TRUE(batch.stress_of(p).allFinite());
  }
}

TEST_P(Robustness, ReversalsOfEstablishedFlow) {
  material::MaterialOptions o;
  o.rate_sensitivity = 1 / GetParam();
  const auto law = material::make_fcc_law(o);
  Batch batch(*law, 4000);
  core::Random random(18, core::Stream::tests);
  material::test::randomise(batch, *law, o, random, 0.01, 0.08);
  batch.run(*law);
  ASSERT_EQ(batch.failures(), 0);
  batch.old = batch.fresh;
  for (int p = 0; p < batch.points; ++p) batch.set_gradient(p, batch.gradient_of(p).inverse());
  for (const double time_step : {0.01, 1e-5, 10.0}) {  // rates over six decades
    batch.time_step = time_step;
    batch.run(*law);
    EXPECT_EQ(batch.failures(), 0) << time_step;
  }
}

INSTANTIATE_TEST_SUITE_P(Exponents, Robustness, ::testing::Values(8.0, 20.0, 50.0, 100.0, 300.0));

}  // namespace
