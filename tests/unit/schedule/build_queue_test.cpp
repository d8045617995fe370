// SPDX-License-Identifier: Apache-2.0
// Which structure is built next, by a clock that is turned by hand.
#include "schedule/build_queue.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/clock.h"

namespace viewloom::build_queue_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr StreamDemand kWatched{.is_watched = true};

struct Stream {
  explicit Stream(const std::string& host) : claim{.payers = {Payer(host)}, .stream = host} {}

  Claim claim;
  StreamTurn turn;
  StreamDemand demand = kWatched;
  bool has_frame = true;
  bool has_waiting = false;
};

class BuildQueueTest : public testing::Test {
 protected:
  BuildQueue::Next take(BuildLane lane = BuildLane::kAny) {
    std::vector<BuildQueue::StreamBuild> builds;
    for (Stream* stream : streams_) {
      builds.push_back({.turn = &stream->turn,
                        .has_frame = [stream] { return stream->has_frame; },
                        .has_waiting = [stream] { return stream->has_waiting; },
                        .demand = [stream] { return stream->demand; },
                        .claim = [stream] { return stream->claim; }});
    }
    return queue_.take({.lane = lane, .change_count = change_count_, .now_ns = clock_.nowNs()},
                       builds);
  }
  // The stream's place, "form", or "" where nothing may be built.
  std::string taken(BuildLane lane = BuildLane::kAny) {
    const BuildQueue::Next next = take(lane);
    if (next.stream) return std::to_string(*next.stream);
    return next.form ? "form" : "";
  }
  void giveBack(Stream& stream, BuildOutcome outcome = BuildOutcome::kServed) const {
    stream.turn.giveBack(outcome, change_count_);
  }
  static FormOrder formOf(ResidentPtr structure, uint64_t px_count = 1) {
    return {.structure = std::move(structure),
            .claim = {.payers = {Payer("viewer")}, .display = "quilt"},
            .px_count = px_count,
            .then = [](const absl::Status&) {}};
  }

  ManualClock clock_;
  FairShares shares_;
  BuildQueue queue_{shares_};
  uint64_t change_count_ = 7;
  Stream first_{"first"};
  Stream second_{"second"};
  std::vector<Stream*> streams_ = {&first_, &second_};
};

TEST_F(BuildQueueTest, buildsOneFrameOfAStreamAtATime) {
  EXPECT_EQ(taken(), "0");
  EXPECT_EQ(taken(), "1");
  EXPECT_EQ(taken(), "");
  giveBack(first_);
  EXPECT_EQ(taken(), "0");
}

TEST_F(BuildQueueTest, leavesStreamsWithoutAFrame) {
  first_.has_frame = false;
  EXPECT_EQ(taken(), "1");
  EXPECT_EQ(taken(), "");
}

TEST_F(BuildQueueTest, buildsForThePayerWhoHasHadLess) {
  shares_.enter(first_.claim);
  shares_.enter(second_.claim);
  shares_.begin(first_.claim, 100 * kMs_ns);
  EXPECT_EQ(taken(), "1");
  giveBack(second_);
  shares_.begin(second_.claim, 500 * kMs_ns);
  EXPECT_EQ(taken(), "0");
}

TEST_F(BuildQueueTest, leavesLongBuildsToTheOtherLane) {
  EXPECT_TRUE(takes(BuildLane::kShort, kShortBuild_ns));
  EXPECT_FALSE(takes(BuildLane::kShort, kShortBuild_ns + 1));
  EXPECT_TRUE(takes(BuildLane::kAny, kShortBuild_ns + 1));
  EXPECT_EQ(taken(BuildLane::kShort), "0");
  giveBack(first_, BuildOutcome::kTooLong);
  EXPECT_EQ(taken(BuildLane::kShort), "1");
  EXPECT_EQ(taken(BuildLane::kShort), "");
  EXPECT_EQ(taken(BuildLane::kAny), "0");
  giveBack(first_);
  EXPECT_EQ(taken(BuildLane::kShort), "0") << "the next frame may be a small one";
}

TEST_F(BuildQueueTest, asksAStreamWithoutASlotAgainWhenSomethingHasChanged) {
  EXPECT_EQ(taken(), "0");
  giveBack(first_, BuildOutcome::kNoSlot);
  EXPECT_EQ(taken(), "1");
  EXPECT_EQ(taken(), "");
  ++change_count_;
  EXPECT_EQ(taken(), "0");
}

TEST_F(BuildQueueTest, leavesAStreamWhoseEngineIsNotReady) {
  EXPECT_EQ(taken(), "0");
  first_.turn.awaitReady();
  giveBack(first_, BuildOutcome::kNotReady);
  ++change_count_;
  EXPECT_EQ(taken(), "1") << "others go on";
  EXPECT_EQ(taken(), "");
  first_.turn.noteReady();
  EXPECT_EQ(taken(), "0");
}

TEST_F(BuildQueueTest, takesAStreamWhoseEngineWasReadyBeforeItWasGivenBack) {
  EXPECT_EQ(taken(), "0");
  first_.turn.awaitReady();
  first_.turn.noteReady();
  giveBack(first_, BuildOutcome::kNotReady);
  EXPECT_EQ(taken(), "0");
}

TEST_F(BuildQueueTest, letsFramesInThatNoPictureAsksForAfterAWhile) {
  streams_ = {&first_};
  first_.has_frame = false;
  first_.has_waiting = true;
  EXPECT_EQ(take().let_in, std::vector<size_t>{0}) << "there is none before";
  first_.turn.noteBuilt(kWatched, clock_.nowNs());
  const int64_t due_ns = clock_.nowNs() + kHeldFrame_ns;
  clock_.advance(400 * kMs_ns);
  const BuildQueue::Next held = take();
  EXPECT_TRUE(held.let_in.empty());
  EXPECT_FALSE(held.stream);
  EXPECT_EQ(held.until_ns, due_ns);
  clock_.advance(due_ns - clock_.nowNs());
  const BuildQueue::Next due = take();
  EXPECT_EQ(due.let_in, std::vector<size_t>{0});
  EXPECT_FALSE(due.stream) << "it is to be decoded first";
}

TEST_F(BuildQueueTest, letsNoFrameInWhileTheOneBeforeIsBuilt) {
  EXPECT_EQ(taken(), "0");
  first_.has_waiting = true;
  EXPECT_TRUE(take().let_in.empty());
}

TEST_F(BuildQueueTest, makesOneFormOfAStructureAtATime) {
  streams_ = {};
  const auto structure = std::make_shared<ResidentStructure>();
  queue_.push(formOf(structure));
  queue_.push(formOf(structure));
  queue_.push(formOf(std::make_shared<ResidentStructure>()));
  const BuildQueue::Next first = take();
  ASSERT_TRUE(first.form);
  EXPECT_EQ(taken(), "form") << "of the other structure";
  EXPECT_EQ(taken(), "");
  queue_.finish(*first.form);
  EXPECT_EQ(taken(), "form");
  EXPECT_EQ(taken(), "");
}

TEST_F(BuildQueueTest, leavesLongFormsToTheOtherLane) {
  streams_ = {};
  constexpr uint64_t kPx = 1'000'000;
  const FormOrder order = formOf(std::make_shared<ResidentStructure>(), kPx);
  for (int i = 0; i < 20; ++i) queue_.noteMade(order, 2 * kShortBuild_ns);
  queue_.push(order);
  EXPECT_EQ(taken(BuildLane::kShort), "");
  for (int i = 0; i < 40; ++i) queue_.noteMade(order, kShortBuild_ns / 2);
  EXPECT_EQ(taken(BuildLane::kShort), "form");
}

TEST_F(BuildQueueTest, ordersFormsAndFramesInFairShares) {
  streams_ = {&first_};
  const FormOrder order = formOf(std::make_shared<ResidentStructure>());
  shares_.enter(first_.claim);
  shares_.enter(order.claim);
  shares_.begin(first_.claim, 100 * kMs_ns);
  queue_.push(order);
  EXPECT_EQ(taken(), "form");
  EXPECT_EQ(taken(), "0");
}

}  // namespace
}  // namespace viewloom::build_queue_test
