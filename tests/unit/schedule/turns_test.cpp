// SPDX-License-Identifier: Apache-2.0
#include "schedule/turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace viewloom::turns_test {
namespace {

struct Work {
  int64_t of_eyes = 0;
  int64_t of_others = 0;
  int64_t longest_wait = 0;  // of eyes, between two of their parts
};

// Both always have a part to do.
template <int64_t kFirstPerOther>
Work share(Turn<kFirstPerOther>& turn, int64_t eyes_part, int64_t other_part) {
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

TEST(ShortTurn, leavesLongAtlasesHalfOfTheWorkAndNoMore) {
  ShortTurn turn;
  const Work done = share(turn, 300, 7000);
  EXPECT_NEAR(double(done.of_others) / double(done.of_eyes), 1, 0.05);
  EXPECT_LE(done.longest_wait, 7000) << "a part at a time";
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

struct Atlas {
  std::string name;
  Claim claim;
  bool has_part = true;
};

class TurnsTest : public testing::Test {
 protected:
  // "first", or "first, then other" where it is the other's turn nevertheless.
  std::string lineUp(const std::vector<Atlas>& atlases) const {
    const auto line = turns_.lineUp(
        atlases, [](const Atlas& atlas) { return atlas.has_part ? &atlas.claim : nullptr; });
    if (line.first == nullptr) return "";
    return line.first->name + (line.in_turn ? ", " + line.in_turn->name + " in turn" : "");
  }

  const Atlas eyes_{"eyes", {.deadline_ns = 900, .is_tracked = true, .turn = 1000}};
  const Atlas soon_{"soon", {.deadline_ns = 100, .turn = 1000}};
  const Atlas late_{"late", {.deadline_ns = 200, .turn = 1000}};
  const Atlas long_{"long", {.deadline_ns = 50, .turn = 1000, .had = 1000}};
  Turns turns_;
};

TEST_F(TurnsTest, lineUpEyesThenTheSoonestThenLongOnes) {
  EXPECT_EQ(lineUp({}), "");
  EXPECT_EQ(lineUp({long_}), "long");
  EXPECT_EQ(lineUp({long_, late_}), "late");
  EXPECT_EQ(lineUp({long_, late_, soon_}), "soon");
  EXPECT_EQ(lineUp({long_, late_, soon_, eyes_}), "eyes");
}

TEST_F(TurnsTest, keepTheOrderOfAtlasesThatAreDueAtOnce) {
  Atlas other = soon_;
  other.name = "other";
  EXPECT_EQ(lineUp({soon_, other}), "soon");
  EXPECT_EQ(lineUp({other, soon_}), "other");
}

TEST_F(TurnsTest, passOverAtlasesThatHaveNothingToDo) {
  Atlas idle = soon_;
  idle.has_part = false;
  EXPECT_EQ(lineUp({idle, late_}), "late");
  EXPECT_EQ(lineUp({idle}), "");
}

TEST_F(TurnsTest, giveOthersAPartForEveryThreeOfEyes) {
  Claim eyes = eyes_.claim;
  turns_.note(eyes, 300);
  EXPECT_EQ(lineUp({eyes_, late_, soon_}), "eyes, soon in turn");
  EXPECT_EQ(lineUp({eyes_}), "eyes");
  Claim soon = soon_.claim;
  turns_.note(soon, 100);
  EXPECT_EQ(lineUp({eyes_, late_, soon_}), "eyes");
}

TEST_F(TurnsTest, giveLongAtlasesEverySecondPartBesideOthers) {
  Claim soon = soon_.claim;
  turns_.note(soon, 100);
  EXPECT_EQ(lineUp({soon_, late_, long_}), "soon, long in turn");
  EXPECT_EQ(lineUp({soon_, late_}), "soon");
  Claim long_one = long_.claim;
  turns_.note(long_one, 100);
  EXPECT_EQ(lineUp({soon_, late_, long_}), "soon");
}

TEST_F(TurnsTest, countWhatAnAtlasHasHadUntilItIsLong) {
  Claim claim = soon_.claim;
  turns_.note(claim, 999);
  EXPECT_FALSE(claim.isLong());
  turns_.note(claim, 1);
  EXPECT_TRUE(claim.isLong());
  Claim eyes = eyes_.claim;
  turns_.note(eyes, 5000);
  EXPECT_FALSE(eyes.isLong()) << "eyes wait for nobody";
}

}  // namespace
}  // namespace viewloom::turns_test
