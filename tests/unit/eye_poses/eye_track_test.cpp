// SPDX-License-Identifier: Apache-2.0
#include "eye_poses/eye_track.h"

#include <gtest/gtest.h>

namespace viewloom::eye_track_test {
namespace {

TEST(EyeTrack, keepsTheNewestPosesAndHowFastTheyCome) {
  EyeTrack track;
  EXPECT_EQ(track.newest(), nullptr);
  EXPECT_EQ(track.times().received_ns, 0);
  track.put({.time_ns = 1, .received_ns = 100});
  EXPECT_EQ(track.times().interval_ns, 0) << "none came before";
  track.put({.time_ns = 2, .received_ns = 130});
  EXPECT_EQ(track.newest()->time_ns, 2);
  EXPECT_EQ(track.times().received_ns, 130);
  EXPECT_EQ(track.times().interval_ns, 30);
}

TEST(EyeTrack, knowsWhichPosesThePictureShows) {
  EyeTrack track;
  track.put({.time_ns = 1});
  EXPECT_EQ(track.used(), nullptr);
  track.noteUsed(track.newest());
  track.put({.time_ns = 2});
  EXPECT_EQ(track.used()->time_ns, 1) << "newer poses are not shown yet";
}

TEST(EyeTrack, goesOnBeforeAnotherDisplayThatShowsNothingYet) {
  EyeTrack before;
  before.put({.time_ns = 1, .received_ns = 100});
  before.put({.time_ns = 2, .received_ns = 130});
  before.noteUsed(before.newest());
  const EyeTrack track(before);
  EXPECT_EQ(track.newest(), before.newest());
  EXPECT_EQ(track.times().interval_ns, 30);
  EXPECT_EQ(track.used(), nullptr);
}

DisplaySpec stereoOf(StereoLayout layout, bool is_tracked = true) {
  return {.kind = StereoSpec{.layout = layout, .eye_size_px = {64, 48}, .is_tracked = is_tracked}};
}

TEST(EyeTrack, goesOnBeforeADisplayOfAsManyEyes) {
  const EyeTrackPtr pair = trackOf(stereoOf(StereoLayout::kSideBySide), nullptr);
  ASSERT_NE(pair, nullptr);
  pair->put({.time_ns = 1});
  const EyeTrackPtr other = trackOf(stereoOf(StereoLayout::kTopBottom), pair);
  EXPECT_EQ(other->newest(), pair->newest());
  const EyeTrackPtr single = trackOf(stereoOf(StereoLayout::kSingle), pair);
  ASSERT_NE(single, nullptr);
  EXPECT_EQ(single->newest(), nullptr) << "two eyes are not one";
  EXPECT_EQ(trackOf(stereoOf(StereoLayout::kSideBySide, false), pair), nullptr);
}

}  // namespace
}  // namespace viewloom::eye_track_test
