// SPDX-License-Identifier: Apache-2.0
#include "lib/silence_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

namespace viewloom::silence_watch_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr SilenceOptions kQuick{.tick = milliseconds(10), .tick_count_max = 30};  // 300 ms
constexpr milliseconds kLonger{800};       // than the silence
constexpr std::chrono::seconds kLong{60};  // only a failing test waits so long

class SilenceWatchTest : public ::testing::Test {
 protected:
  bool firesWithin(std::chrono::nanoseconds time) {
    return fired_.get_future().wait_for(time) == std::future_status::ready;
  }

  std::promise<void> fired_;
  SilenceWatch watch_{[this] { fired_.set_value(); }, kQuick};
};

TEST_F(SilenceWatchTest, firesWhenAServerWithHeartbeatsFallsSilent) {
  watch_.expectHeartbeats();
  const auto begun = steady_clock::now();
  watch_.listens();
  ASSERT_TRUE(firesWithin(kLong));
  EXPECT_GE(steady_clock::now() - begun, kQuick.tick * (kQuick.tick_count_max - 1));
  EXPECT_TRUE(watch_.hasFired());
  EXPECT_EQ(watch_.status().code(), absl::StatusCode::kUnavailable);
}

TEST_F(SilenceWatchTest, letsServersWithoutHeartbeatsBeSilent) {
  watch_.listens();
  EXPECT_FALSE(firesWithin(kLonger));
  EXPECT_FALSE(watch_.hasFired());
}

// A callback of the reader may take its time: the server is not to blame.
TEST_F(SilenceWatchTest, countsTheTimeOfWaitingAlone) {
  watch_.expectHeartbeats();
  watch_.listens();
  watch_.hears();
  EXPECT_FALSE(firesWithin(kLonger));
}

TEST_F(SilenceWatchTest, countsAnewWithEachMessage) {
  watch_.expectHeartbeats();
  for (int i = 0; i < 30; ++i) {
    watch_.listens();
    std::this_thread::sleep_for(kQuick.tick * 2);
    watch_.hears();
  }
  EXPECT_FALSE(watch_.hasFired());
}

TEST(SilenceWatch, saysForHowLongTheServerWasSilent) {
  const SilenceWatch watch([] {});
  EXPECT_EQ(watch.status().message(), "the server has been silent for 5 s");
}

}  // namespace
}  // namespace viewloom::silence_watch_test
