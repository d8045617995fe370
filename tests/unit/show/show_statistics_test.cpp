// SPDX-License-Identifier: Apache-2.0
#include "show/show_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::show::show_statistics_test {
namespace {

TEST(ShownRate, isOverHalfASecondOrMore) {
  ShownRate rate;
  rate.perSecond(1'000'000'000);
  for (int i = 0; i < 30; ++i) rate.count();
  EXPECT_EQ(rate.perSecond(1'400'000'000), 0) << "too early for another";
  EXPECT_EQ(rate.perSecond(2'000'000'000), 30);
  EXPECT_EQ(rate.perSecond(3'000'000'000), 0) << "nothing more came";
}

TEST(Statistics, sayWhatIsKnown) {
  v1::AtlasLayout layout;
  layout.set_view_count(48);
  layout.set_focal_distance_m(1.25);
  const ShowStatistics statistics{.rate_hz = 29.97,
                                  .dropped_count = 3,
                                  .latency_s = 0.0414,
                                  .frame_number = 17,
                                  .is_connected = true};
  EXPECT_EQ(describe(statistics, {.mode = ShowMode::kView, .view = 12}, layout),
            "frame 17\n30.0 /s, 3 dropped, latency 41 ms\nview 12 of 48\nfocal plane 1.250 m");
  EXPECT_THAT(describe({}, {.mode = ShowMode::kWeave}, layout),
              testing::AllOf(testing::HasSubstr("no server"), testing::HasSubstr("unknown"),
                             testing::HasSubstr("weave, 48 views, blended")));
}

}  // namespace
}  // namespace viewloom::show::show_statistics_test
