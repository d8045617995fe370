// SPDX-License-Identifier: Apache-2.0
// Which of several claims goes first.
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/cost_estimate.h"
#include "schedule/fair_shares.h"

namespace viewloom::claim_order_test {
namespace {

class OrderOfClaims : public testing::Test {
 protected:
  static Claim claim(const std::string& identity, const std::string& display, int64_t deadline_ns,
                     bool is_tracked = false) {
    return {.deadline_ns = deadline_ns,
            .is_tracked = is_tracked,
            .payers = {Payer(identity)},
            .stream = "s",
            .display = display};
  }
  void work(const Claim& claim, int64_t time_ns) {
    shares_.begin(claim, time_ns);
    shares_.finish(claim, time_ns, time_ns);
  }
  std::string next(const std::vector<Claim>& claims) const {
    const Claim* const first = shares_.next(claims, [](const Claim& claim) { return &claim; });
    return first == nullptr ? "" : first->display;
  }

  FairShares shares_;
  const Claim eyes_ = claim("10.0.0.1", "eyes", 900, true);
  const Claim soon_ = claim("10.0.0.1", "soon", 100);
  const Claim late_ = claim("10.0.0.1", "late", 200);
};

TEST_F(OrderOfClaims, ofOneIdentityIsEyesThenTheSoonestDeadline) {
  EXPECT_EQ(next({}), "");
  EXPECT_EQ(next({late_, soon_}), "soon");
  EXPECT_EQ(next({late_, soon_, eyes_}), "eyes");
  EXPECT_TRUE(shares_.goesBefore(soon_, late_));
  EXPECT_FALSE(shares_.goesBefore(late_, soon_));
  EXPECT_FALSE(shares_.goesBefore(soon_, soon_));
}

TEST_F(OrderOfClaims, passesOverWhoHasNothingToDo) {
  EXPECT_EQ(shares_.nextOf({nullptr, &late_}), 1U);
  EXPECT_EQ(shares_.nextOf({nullptr}), std::nullopt);
}

TEST_F(OrderOfClaims, leavesOthersAPartForEveryThreeOfEyes) {
  work(eyes_, 3000);
  EXPECT_EQ(next({eyes_, late_, soon_}), "soon");
  EXPECT_EQ(next({eyes_}), "eyes");
  work(soon_, 1000);
  EXPECT_EQ(next({eyes_, late_, soon_}), "eyes");
}

TEST_F(OrderOfClaims, putsEyesOfOneIdentityNotBeforeAnother) {
  const Claim quilt = claim("10.0.0.2", "quilt", 5000);
  work(eyes_, kPiece_ns);
  EXPECT_EQ(next({eyes_, quilt}), "quilt");
  work(quilt, 2 * kPiece_ns);
  EXPECT_EQ(next({eyes_, quilt}), "eyes");
}

TEST_F(OrderOfClaims, keepsToDeadlinesUntilOneDisplayHasHadMoreThanMostAtlasesNeed) {
  shares_.enter(soon_);
  shares_.enter(late_);
  work(soon_, kInOrder_ns);
  EXPECT_EQ(next({soon_, late_}), "soon");
  work(soon_, kPiece_ns);
  EXPECT_EQ(next({soon_, late_}), "late");
}

TEST_F(OrderOfClaims, startsAnAtlasBesideAnotherThatIsOverdueAndTakesHours) {
  const Claim overdue = claim("10.0.0.1", "overdue", -1000);
  shares_.enter(overdue);
  for (int i = 0; i < 100; ++i) work(overdue, kPiece_ns);
  shares_.enter(late_);
  EXPECT_EQ(next({overdue, late_}), "late");
  work(late_, kPiece_ns);
  work(late_, kPiece_ns);
  EXPECT_EQ(next({overdue, late_}), "overdue");
}

}  // namespace
}  // namespace viewloom::claim_order_test
