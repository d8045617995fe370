// SPDX-License-Identifier: Apache-2.0
#include "publish/stream_directory.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/retry_delay.h"

namespace viewloom::stream_directory_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class StreamDirectoryTest : public testing::Test {
 protected:
  std::unique_ptr<StreamDirectory::Claim> mustClaim(const std::string& stream,
                                                    const std::string& session_id = "",
                                                    std::function<void()> on_takeover = {}) {
    auto claim = directory_.claim(stream, session_id, std::move(on_takeover));
    EXPECT_TRUE(claim.ok()) << claim.status();
    return *std::move(claim);
  }

  ManualClock clock_;
  StreamDirectory directory_{clock_, 2};
};

TEST_F(StreamDirectoryTest, keepsTheEntryWhenThePublisherLeaves) {
  auto claim = mustClaim("s");
  EXPECT_TRUE(directory_.list().at(0).live);
  claim.reset();
  EXPECT_TRUE(directory_.exists("s"));
  EXPECT_FALSE(directory_.list().at(0).live);
  const auto again = mustClaim("s");
  EXPECT_TRUE(directory_.list().at(0).live);
}

TEST_F(StreamDirectoryTest, refusesASecondPublisherWithoutTheSession) {
  int takeover_count = 0;
  const auto holder = mustClaim("s", "secret", [&] { ++takeover_count; });
  for (const std::string session_id : {"", "guess"}) {
    EXPECT_EQ(directory_.claim("s", session_id, {}).status().code(),
              absl::StatusCode::kAlreadyExists);
  }
  EXPECT_EQ(takeover_count, 0);
}

TEST_F(StreamDirectoryTest, neverTakesOverAStreamWithoutASession) {
  const auto holder = mustClaim("s");
  EXPECT_EQ(directory_.claim("s", "", {}).status().code(), absl::StatusCode::kAlreadyExists);
}

TEST_F(StreamDirectoryTest, handsTheStreamToTheSameSessionAndTellsTheOldHolderOnce) {
  int takeover_count = 0;
  auto old_claim = mustClaim("s", "secret", [&] { ++takeover_count; });
  auto new_claim = mustClaim("s", "secret");
  EXPECT_EQ(takeover_count, 1);
  old_claim.reset();  // no longer its stream
  EXPECT_TRUE(directory_.list().at(0).live);
  new_claim.reset();
  EXPECT_FALSE(directory_.list().at(0).live);
  EXPECT_EQ(takeover_count, 1);
}

TEST_F(StreamDirectoryTest, letsAnySessionHaveAStreamThatIsFree) {
  mustClaim("s", "one").reset();
  const auto claim = mustClaim("s", "two");
  EXPECT_EQ(directory_.claim("s", "one", {}).status().code(), absl::StatusCode::kAlreadyExists);
}

TEST_F(StreamDirectoryTest, saysWhoHasTheNameAndSinceWhen) {
  const auto holder = *directory_.claim("s", "one", {}, "10.0.0.7");
  clock_.advance(90'000'000'000);
  const absl::Status refused = directory_.claim("s", "two", {}, "10.0.0.8").status();
  EXPECT_THAT(std::string(refused.message()), HasSubstr("on 10.0.0.7, for 90 s"));
  EXPECT_FALSE(retryDelayNs(refused)) << "another user's stream";
}

TEST_F(StreamDirectoryTest, letsTheSameHostWaitForTheName) {
  auto holder = *directory_.claim("s", "one", {}, "10.0.0.7");
  const absl::Status refused = directory_.claim("s", "two", {}, "10.0.0.7").status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kAlreadyExists);
  EXPECT_TRUE(retryDelayNs(refused));
  holder.reset();
  EXPECT_TRUE(directory_.claim("s", "two", {}, "10.0.0.7").ok());
}

TEST_F(StreamDirectoryTest, numbersSessionsAndKnowsOneThatComesBack) {
  const uint64_t first = mustClaim("s", "one")->session();
  EXPECT_EQ(mustClaim("s", "one")->session(), first);
  const uint64_t second = mustClaim("s", "two")->session();
  EXPECT_NE(second, first);
  EXPECT_NE(mustClaim("s", "one")->session(), first) << "another one had the stream since";
  const uint64_t nameless = mustClaim("s")->session();
  EXPECT_NE(mustClaim("s")->session(), nameless) << "nothing says that they are one";
}

TEST_F(StreamDirectoryTest, refusesOverTheLimit) {
  const auto a = mustClaim("a");
  const auto b = mustClaim("b");
  EXPECT_EQ(directory_.claim("c", "", {}).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_FALSE(directory_.exists("c"));
}

TEST_F(StreamDirectoryTest, makesRoomByForgettingTheStreamLongestWithoutAPublisher) {
  mustClaim("watched").reset();
  clock_.advance(1);
  mustClaim("gone").reset();
  std::vector<std::string> asked;
  directory_.onRoomNeeded([&](const std::string& stream) {
    asked.push_back(stream);
    return stream != "watched";
  });
  const auto claim = mustClaim("new");
  EXPECT_THAT(asked, ElementsAre("watched", "gone"));
  EXPECT_TRUE(directory_.exists("watched"));
  EXPECT_FALSE(directory_.exists("gone"));
}

TEST_F(StreamDirectoryTest, neverForgetsALiveStream) {
  const auto a = mustClaim("a");
  const auto b = mustClaim("b");
  directory_.onRoomNeeded([](const std::string&) { return true; });
  EXPECT_EQ(directory_.claim("c", "", {}).status().code(), absl::StatusCode::kResourceExhausted);
}

TEST_F(StreamDirectoryTest, listsByNameWithCountsAndStats) {
  const auto b = mustClaim("b");
  const auto a = mustClaim("a");
  directory_.countReceived("b");
  directory_.countReceived("b");
  for (const FrameOutcome outcome :
       {FrameOutcome::kReplaced, FrameOutcome::kRefused, FrameOutcome::kTraced,
        FrameOutcome::kBuiltWithoutDisplay, FrameOutcome::kUnchanged}) {
    directory_.countReported("b", outcome);
  }
  directory_.countReceived("unknown");
  directory_.noteResident("b", 7, {640, 480}, 2, {.depth_step = 0.5});
  const std::vector<StreamEntry> entries = directory_.list();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].name, "a");
  EXPECT_EQ(entries[1].name, "b");
  EXPECT_EQ(entries[1].received_count, 2u);
  EXPECT_EQ(entries[1].replaced_count, 1u);
  EXPECT_EQ(entries[1].refused_count, 1u);
  EXPECT_EQ(entries[1].used_count, 3u);
  EXPECT_EQ(entries[1].frame_number, 7u);
  EXPECT_EQ(entries[1].size_px, (SizePx{640, 480}));
  EXPECT_EQ(entries[1].layer_count, 2u);
  EXPECT_EQ(entries[1].stats.depth_step, 0.5);
}

TEST_F(StreamDirectoryTest, measuresTheRateOverTheLastTwoSeconds) {
  const auto claim = mustClaim("s");
  directory_.countReceived("s");
  EXPECT_EQ(directory_.list()[0].rate_hz, 0);
  for (int i = 0; i < 600; ++i) {
    clock_.advance(40'000'000);
    directory_.countReceived("s");
  }
  EXPECT_DOUBLE_EQ(directory_.list()[0].rate_hz, 25);
  for (int i = 0; i < 5000; ++i) {
    clock_.advance(1'000'000);
    directory_.countReceived("s");
  }
  EXPECT_DOUBLE_EQ(directory_.list()[0].rate_hz, 1000);
  clock_.advance(3'000'000'000);
  EXPECT_EQ(directory_.list()[0].rate_hz, 0);
}

TEST_F(StreamDirectoryTest, givesAStreamToExactlyOneOfManyThreads) {
  std::atomic<int> takeover_count = 0;
  std::atomic<int> claim_count = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int round = 0; round < 200; ++round) {
          auto claim = directory_.claim("s", "secret", [&] { ++takeover_count; });
          claim_count += claim.ok();
          directory_.countReceived("s");
          directory_.list();
        }
      });
    }
  }
  EXPECT_EQ(claim_count, 800);
  EXPECT_LT(takeover_count, 800);
  EXPECT_FALSE(directory_.list().at(0).live);
  EXPECT_EQ(directory_.list()[0].received_count, 800u);
}

TEST_F(StreamDirectoryTest, forgetsTheOldestOfThoseLongWithoutAPublisher) {
  StreamDirectory directory(clock_, 8);
  std::vector<std::string> asked;
  directory.onRoomNeeded([&](const std::string& stream) {
    asked.push_back(stream);
    return stream != "watched";
  });
  for (const char* const stream : {"watched", "older", "newer"}) {
    directory.claim(stream, "", {})->reset();
    clock_.advance(10);
  }
  const auto live = directory.claim("live", "", {});
  EXPECT_FALSE(directory.forgetOldest(1000));
  EXPECT_TRUE(asked.empty());
  EXPECT_TRUE(directory.forgetOldest(20));
  EXPECT_FALSE(directory.exists("older"));
  EXPECT_FALSE(directory.forgetOldest(20)) << "the newer one was released too lately";
  EXPECT_TRUE(directory.forgetOldest(0));
  EXPECT_FALSE(directory.forgetOldest(0));
  EXPECT_TRUE(directory.exists("watched"));
  EXPECT_TRUE(directory.exists("live"));
}

}  // namespace
}  // namespace viewloom::stream_directory_test
