// SPDX-License-Identifier: Apache-2.0
#include "schedule/frame_door.h"

#include <gtest/gtest.h>

namespace viewloom::frame_door_test {
namespace {

using Answer = FrameDoor::Answer;
using Opened = FrameDoor::Opened;

TEST(FrameDoor, letsAFrameInThatIsWanted) {
  FrameDoor door;
  EXPECT_EQ(door.knock(), Answer::kFirst);
  EXPECT_EQ(door.knock(), Answer::kWaitOn);
  EXPECT_TRUE(door.hasWaiting());
  EXPECT_FALSE(door.isOpen());
  EXPECT_EQ(door.open(), Opened::kNow);
  EXPECT_FALSE(door.hasWaiting());
  EXPECT_TRUE(door.isOpen());
  EXPECT_EQ(door.knock(), Answer::kComeIn);
}

TEST(FrameDoor, keepsTheNextFrameOutUntilTheOneBeforeIsBuilt) {
  FrameDoor door;
  door.knock();
  door.open();
  EXPECT_EQ(door.knock(), Answer::kComeIn);
  EXPECT_EQ(door.knock(), Answer::kWaitOn);
  EXPECT_EQ(door.open(), Opened::kBefore) << "that comes for all who ask";
  EXPECT_EQ(door.knock(), Answer::kWaitOn);
  EXPECT_FALSE(door.hasWaiting());
  door.close();
  EXPECT_FALSE(door.isOpen());
  EXPECT_EQ(door.knock(), Answer::kFirst);
}

TEST(FrameDoor, opensForNobodyWhileNoFrameWaits) {
  FrameDoor door;
  EXPECT_EQ(door.open(), Opened::kNobody);
  EXPECT_FALSE(door.isOpen());
  EXPECT_EQ(door.knock(), Answer::kFirst) << "it was not left open";
}

TEST(FrameDoor, takesFramesThatHaveComeInWithoutKnocking) {
  FrameDoor door;
  EXPECT_TRUE(door.enter());
  EXPECT_FALSE(door.enter()) << "one waits";
  EXPECT_TRUE(door.hasWaiting());
  EXPECT_EQ(door.open(), Opened::kNow);
  EXPECT_FALSE(door.enter()) << "it is the one that is wanted";
  EXPECT_EQ(door.knock(), Answer::kWaitOn);
  door.close();
  EXPECT_TRUE(door.enter());
}

}  // namespace
}  // namespace viewloom::frame_door_test
