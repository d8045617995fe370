// SPDX-License-Identifier: Apache-2.0
// Room for encodings of a server on two cores or fewer, with a clock that is turned by hand.
#include "admission/coding_room.h"

#include <gtest/gtest.h>

namespace viewloom::coding_room_test {
namespace {

constexpr int64_t kMs = 1'000'000;

class CodingRoomTest : public testing::Test {
 protected:
  explicit CodingRoomTest(double core_count = 2) : room_(core_count, [this] { return used_ns_; }) {}

  // The server keeps so many cores busy.
  void run(int64_t duration_ms, double busy_core_count) {
    for (const int64_t end_ns = now_ns_ + duration_ms * kMs; now_ns_ < end_ns;) {
      now_ns_ += 250 * kMs;
      used_ns_ += int64_t(busy_core_count * 250 * kMs);
      room_.look(now_ns_);
    }
  }

  int64_t now_ns_ = 0;
  int64_t used_ns_ = 0;
  CodingRoom room_;
};

TEST_F(CodingRoomTest, grantsTimeThatNobodyTakes) {
  EXPECT_FALSE(room_.take(0.1, now_ns_)) << "nothing is known yet";
  run(2000, 1);
  EXPECT_FALSE(room_.take(0.7, now_ns_)) << "1.7 of 2 cores";
  EXPECT_TRUE(room_.take(0.5, now_ns_));
}

TEST_F(CodingRoomTest, grantsTheNextOnceTheLastOneShows) {
  run(2000, 0.2);
  EXPECT_TRUE(room_.take(0.9, now_ns_));
  EXPECT_FALSE(room_.take(0.3, now_ns_));
  run(2500, 1.1);
  EXPECT_TRUE(room_.take(0.3, now_ns_));
  run(2500, 1.4);
  EXPECT_FALSE(room_.take(0.3, now_ns_));
}

TEST_F(CodingRoomTest, grantsAgainWhatWasGivenBack) {
  run(2000, 0.2);
  EXPECT_TRUE(room_.take(0.9, now_ns_));
  room_.giveBack();
  EXPECT_TRUE(room_.take(0.9, now_ns_));
}

TEST_F(CodingRoomTest, isOverOnceAllTimeIsTakenForAWhile) {
  run(2000, 1);
  run(2000, 2);
  EXPECT_FALSE(room_.isOver()) << "a burst";
  run(500, 1);
  run(6000, 1.98);
  EXPECT_TRUE(room_.isOver());
  EXPECT_FALSE(room_.take(0, now_ns_));
  run(1000, 1);
  EXPECT_FALSE(room_.isOver());
}

class CodingRoomOfAQuota : public CodingRoomTest {
 protected:
  CodingRoomOfAQuota() : CodingRoomTest(1.5) {}
};

TEST_F(CodingRoomOfAQuota, grantsPartsOfACore) {
  run(2000, 0.9);
  EXPECT_FALSE(room_.take(0.4, now_ns_)) << "1.3 of 1.5 cores, though two would have room";
  EXPECT_TRUE(room_.take(0.2, now_ns_));
}

TEST_F(CodingRoomOfAQuota, isOverOnceTheQuotaIsUsedUp) {
  run(6000, 1.48);
  EXPECT_TRUE(room_.isOver());
}

TEST(NoCodingRoom, grantsNothing) {
  noCodingRoom().look(0);
  noCodingRoom().look(1500 * kMs);
  EXPECT_FALSE(noCodingRoom().take(0, 1500 * kMs));
  EXPECT_FALSE(noCodingRoom().isOver());
}

}  // namespace
}  // namespace viewloom::coding_room_test
