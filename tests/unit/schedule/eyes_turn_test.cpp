// SPDX-License-Identifier: Apache-2.0
#include "schedule/eyes_turn.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace viewloom::eyes_turn_test {
namespace {

struct Work {
  int64_t of_eyes = 0;
  int64_t of_others = 0;
  int64_t longest_wait = 0;  // of eyes, between two of their parts
};

// Both always have a part to do.
Work share(EyesTurn& turn, int64_t eyes_part, int64_t other_part) {
  Work done;
  int64_t wait = 0;
  for (int i = 0; i < 10'000; ++i) {
    const bool is_of_eyes = !turn.isOver();
    turn.note(is_of_eyes, is_of_eyes ? eyes_part : other_part);
    (is_of_eyes ? done.of_eyes : done.of_others) += is_of_eyes ? eyes_part : other_part;
    wait = is_of_eyes ? 0 : wait + other_part;
    done.longest_wait = std::max(done.longest_wait, wait);
  }
  return done;
}

TEST(EyesTurn, leavesOthersAQuarterOfTheWorkWhateverTheirParts) {
  struct Parts {
    int64_t eyes;
    int64_t other;
  };
  for (const Parts& parts : {Parts{300, 300}, {300, 7000}, {7000, 300}, {3000, 1000}}) {
    SCOPED_TRACE(parts.other);
    EyesTurn turn;
    const Work done = share(turn, parts.eyes, parts.other);
    EXPECT_NEAR(double(done.of_others) / double(done.of_eyes), 1.0 / 3, 0.02);
    EXPECT_LE(done.longest_wait, parts.eyes / 3 + parts.other);
  }
}

TEST(EyesTurn, owesNobodyForTheTimeBeforeHeCame) {
  EyesTurn turn;
  for (int i = 0; i < 1000; ++i) turn.note(true, 300);
  EXPECT_TRUE(turn.isOver());
  turn.note(false, 300);
  EXPECT_FALSE(turn.isOver()) << "one part is all that was owed";
  for (int i = 0; i < 1000; ++i) turn.note(false, 300);  // no eyes moved
  int parts = 0;
  for (; !turn.isOver(); ++parts) turn.note(true, 300);
  EXPECT_LE(parts, 4) << "nor are eyes owed anything";
}

}  // namespace
}  // namespace viewloom::eyes_turn_test
