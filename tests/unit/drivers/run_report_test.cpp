#include "drivers/run_report.hpp"

#include <gtest/gtest.h>

namespace polyslip::tests {
namespace {

// Every value of a grain stands in a column of its own, so no two can be exchanged unseen.
TEST(RunReport, TheTableOfARemeshingHasEachGrainBeforeAndAfter) {
  remap::GrainStatistics before, after;
  before.volume = 1;
  before.spread = 3;
  before.g = {.mean = 5, .min = 7, .max = 9};
  before.slip = {.mean = 11, .min = 13, .max = 15};
  before.elastic_energy = 17;
  before.volume_at_zero_pressure = 19;
  after.volume = 2;
  after.spread = 4;
  after.g = {.mean = 6, .min = 8, .max = 10};
  after.slip = {.mean = 12, .min = 14, .max = 16};
  after.elastic_energy = 18;
  after.volume_at_zero_pressure = 20;
  remap::RemeshReport report;
  report.grains_before = {before, before};
  report.grains_after = {after, after};
  EXPECT_EQ(drivers::remeshing_table(report),
            "grain,volume_before,volume_after,rotation,spread_before,spread_after,g_before,g_after,"
            "g_min_before,g_min_after,g_max_before,g_max_after,slip_before,slip_after,"
            "slip_min_before,slip_min_after,slip_max_before,slip_max_after,elastic_energy_before,"
            "elastic_energy_after,volume_at_zero_pressure_before,volume_at_zero_pressure_after\n"
            "1,1,2,0,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20\n"
            "2,1,2,0,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20\n");
}

}  // namespace
}  // namespace polyslip::tests
