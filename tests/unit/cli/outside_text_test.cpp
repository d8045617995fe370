// SPDX-License-Identifier: Apache-2.0
#include "cli/outside_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::cli::outside_text_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

void addRun(v1::DisplayOutside& display, uint32_t first, uint32_t last, double share) {
  v1::ViewsOutside& views = *display.add_views();
  views.set_first_view(first);
  views.set_last_view(last);
  views.set_share(share);
}

v1::Wanted wantedOf(double share) {
  v1::Wanted wanted;
  wanted.mutable_fov()->set_angle_left_rad(-0.45);
  wanted.mutable_fov()->set_angle_right_rad(0.45);
  wanted.mutable_fov()->set_angle_down_rad(-0.2);
  wanted.mutable_fov()->set_angle_up_rad(0.2);
  v1::DisplayOutside& display = *wanted.add_outside();
  display.set_display_id(2);
  addRun(display, 0, 6, share);
  addRun(display, 47, 47, 0.07);
  return wanted;
}

TEST(OutsideText, namesRunsAndRoundsUp) {
  EXPECT_EQ(outsideText(wantedOf(0.031).outside(0).views()), "views 0-6 by 4 %, view 47 by 7 %");
  EXPECT_EQ(outsideText({}), "");
}

TEST(OutsideWarnings, areSaidAgainOnlyWhenMoreIsWanted) {
  OutsideWarnings warnings;
  EXPECT_THAT(warnings.note({}), IsEmpty());
  EXPECT_THAT(
      warnings.note(wantedOf(0.04)),
      ElementsAre("display 2 sees past the edge of the source: views 0-6 by 4 %, view 47 by 7 %. "
                  "It needs a field of view of 52 x 23 degrees"));
  EXPECT_THAT(warnings.note(wantedOf(0.04)), IsEmpty());
  // The page asks for other views of its display whenever the pointer moves.
  v1::Wanted moved = wantedOf(0.02);
  moved.mutable_outside(0)->set_display_id(3);
  moved.mutable_fov()->set_angle_left_rad(-0.44);
  EXPECT_THAT(warnings.note(moved), IsEmpty());
  EXPECT_THAT(warnings.note({}), IsEmpty());
  EXPECT_THAT(warnings.note(wantedOf(0.04)), IsEmpty());
  v1::Wanted wider = wantedOf(0.05);
  wider.mutable_fov()->set_angle_left_rad(-0.5);
  EXPECT_THAT(
      warnings.note(wider),
      ElementsAre("display 2 sees past the edge of the source: views 0-6 by 5 %, view 47 by 7 %. "
                  "It needs a field of view of 55 x 23 degrees"));
}

}  // namespace
}  // namespace viewloom::cli::outside_text_test
