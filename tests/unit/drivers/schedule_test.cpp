#include "drivers/schedule.hpp"

#include <gtest/gtest.h>

namespace polyslip::drivers {
namespace {

TEST(Schedule, MergesStrainsThatAreTheSame) {
  const auto events = schedule({0.1, 0.2, 0.3}, {0.3}, 0.1, 0.6);
  ASSERT_EQ(events.size(), 6u);
  EXPECT_EQ(events[2].strain, 0.3);  // the deck's digits, not 3 * 0.1
  EXPECT_TRUE(events[2].store && events[2].checkpoint && events[2].remesh);
  EXPECT_FALSE(events[2].final);
  EXPECT_TRUE(events[0].store && events[0].checkpoint);
  EXPECT_TRUE(events[3].checkpoint);
  EXPECT_FALSE(events[3].store);
  EXPECT_TRUE(events[5].final && events[5].store && events[5].checkpoint);
}

TEST(Schedule, LeavesOutTheStart) {
  const auto events = schedule({0.0, 0.5}, {}, 0, 0.5);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].strain, 0.5);
}

TEST(Schedule, FindsNextAndPresentEvents) {
  const auto events = schedule({0.1}, {}, 0, 0.2);
  EXPECT_EQ(next_event(events, 0)->strain, 0.1);
  EXPECT_EQ(next_event(events, 0.1)->strain, 0.2);
  EXPECT_EQ(next_event(events, 0.2), nullptr);
  EXPECT_EQ(event_at(events, 0.15), nullptr);
  EXPECT_EQ(event_at(events, 0.1 + 1e-12)->strain, 0.1);
}

}  // namespace
}  // namespace polyslip::drivers
