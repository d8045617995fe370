// SPDX-License-Identifier: Apache-2.0
#include "rpc/live_calls.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace viewloom::live_calls_test {
namespace {

class NamedCall {
 public:
  explicit NamedCall(std::string identity) : identity_(std::move(identity)) {}

  const std::string& identity() const { return identity_; }
  void open() { is_open_ = true; }
  void end(const absl::Status& status) { status_ = status; }
  bool isTurnedAway() const { return is_open_ && !status_.ok(); }

 private:
  const std::string identity_;
  bool is_open_ = false;
  absl::Status status_ = absl::OkStatus();
};

class LiveCallsTest : public testing::Test {
 protected:
  // How many of them were not turned away.
  size_t open(const std::string& identity, size_t count) { return openIn(calls_, identity, count); }
  size_t openIn(LiveCalls<NamedCall>& calls, const std::string& identity, size_t count) {
    size_t opened_count = 0;
    for (size_t i = 0; i < count; ++i) {
      kept_.push_back(std::make_shared<NamedCall>(identity));
      calls.open(kept_.back());
      if (!kept_.back()->isTurnedAway()) ++opened_count;
    }
    return opened_count;
  }

  static constexpr size_t kFitting = 100;

  MemoryBudget budget_{kFitting * kOpenCallBytes};
  LiveCalls<NamedCall> calls_{unboundedMemory()};
  LiveCalls<NamedCall> priced_{budget_};
  std::vector<std::shared_ptr<NamedCall>> kept_;
};

TEST_F(LiveCallsTest, leavesPlacesToOthers) {
  EXPECT_EQ(open("greedy", kOpenCallsMax), kOpenCallsMax * 3 / 4);
  EXPECT_EQ(open("modest", 100), 100U);
  EXPECT_EQ(open("greedy", 1), 0U);
  kept_.clear();
  EXPECT_EQ(open("greedy", 1), 1U);
}

TEST_F(LiveCallsTest, takeMemoryOfTheirClientUntilTheyEnd) {
  EXPECT_EQ(openIn(priced_, "greedy", kFitting), kFitting * 3 / 4);
  EXPECT_EQ(openIn(priced_, "modest", 1), 1U);
  EXPECT_EQ(budget_.reservedBytes(MemoryUse::kConnections),
            (kFitting * 3 / 4 + 1) * kOpenCallBytes);
  kept_.clear();
  priced_.forEach([](NamedCall&) {});
  EXPECT_EQ(budget_.reservedBytes(), 0U);
}

}  // namespace
}  // namespace viewloom::live_calls_test
