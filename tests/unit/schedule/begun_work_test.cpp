// SPDX-License-Identifier: Apache-2.0
// Which of the atlases that an engine has begun gets its next part made.
#include "schedule/begun_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace viewloom::begun_work_test {
namespace {

using testing::ElementsAre;

struct FakeRun {
  std::string name;
  Claim claim;
};
using RunPtr = std::shared_ptr<FakeRun>;

RunPtr runOf(const std::string& host, int64_t deadline_ns, bool is_tracked = false) {
  return std::make_shared<FakeRun>(FakeRun{
      host, {.deadline_ns = deadline_ns, .is_tracked = is_tracked, .payers = {Payer(host)}}});
}

class BegunWorkTest : public testing::Test {
 protected:
  // Names of those that were asked, in this order, while only `served` has room.
  std::vector<std::string> askedUntil(const std::string& served) {
    std::vector<std::string> asked;
    begun_.makeNext([&](const RunPtr& run) {
      asked.push_back(run->name);
      return run->name == served;
    });
    return asked;
  }

  FairShares shares_;
  BegunWork<FakeRun> begun_{shares_};
};

TEST_F(BegunWorkTest, makesThePartOfTheOneThatGoesFirst) {
  begun_.add(runOf("late", 20));
  begun_.add(runOf("soon", 10));
  shares_.begin(begun_.all().front()->claim, 500'000'000);
  EXPECT_THAT(askedUntil("soon"), ElementsAre("soon"));
  EXPECT_EQ(begun_.firstClaim(), &begun_.all().back()->claim);
}

TEST_F(BegunWorkTest, asksOthersOnceEachWhileTheFirstHasNoRoom) {
  for (const char* name : {"a", "b", "c"}) begun_.add(runOf(name, 0));
  shares_.begin(begun_.all()[0]->claim, 900'000'000);
  shares_.begin(begun_.all()[1]->claim, 500'000'000);
  EXPECT_THAT(askedUntil("a"), ElementsAre("c", "b", "a"));
  EXPECT_THAT(askedUntil("b"), ElementsAre("c", "b"));
  EXPECT_THAT(askedUntil("nobody"), ElementsAre("c", "b", "a"));
  EXPECT_FALSE(begun_.makeNext([](const RunPtr&) { return false; }));
}

TEST_F(BegunWorkTest, letsAPartBeTheLast) {
  begun_.add(runOf("a", 0));
  EXPECT_TRUE(begun_.makeNext([this](const RunPtr& run) {
    begun_.remove(*run);
    return true;
  }));
  EXPECT_TRUE(begun_.isEmpty());
  EXPECT_EQ(begun_.firstClaim(), nullptr);
  EXPECT_FALSE(begun_.makeNext([](const RunPtr&) { return true; }));
}

TEST_F(BegunWorkTest, knowsWhoseTrackedDisplaysHaveBegun) {
  begun_.add(runOf("still", 0));
  begun_.add(runOf("tracked", 0, true));
  EXPECT_TRUE(begun_.hasTracked({Payer("tracked")}));
  EXPECT_FALSE(begun_.hasTracked({Payer("still")}));
  begun_.clear();
  EXPECT_FALSE(begun_.hasTracked({Payer("tracked")}));
}

}  // namespace
}  // namespace viewloom::begun_work_test
