// SPDX-License-Identifier: Apache-2.0
#include "lib/server_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "lib/latency.h"

namespace viewloom::server_clock_test {
namespace {

constexpr int64_t kMs = 1'000'000;

// A probe of that time, on its way so long there and back; the server takes 1 ms to answer.
struct Way {
  int64_t asked_ns = 0;
  int64_t there_ns = 0;
  int64_t back_ns = 0;
};

void ask(ServerClock& clock, const Way& way, int64_t ahead_ns) {
  v1::ClockReply reply;
  reply.set_client_time_ns(way.asked_ns);
  reply.set_server_received_ns(way.asked_ns + way.there_ns + ahead_ns);
  reply.set_server_sent_ns(reply.server_received_ns() + kMs);
  clock.add(reply, way.asked_ns + way.there_ns + kMs + way.back_ns);
}

TEST(ServerClock, isKnownExactlyWhereBothWaysAreAlike) {
  ServerClock clock;
  EXPECT_EQ(clock.offset(), std::nullopt);
  ask(clock, {50, 3 * kMs, 3 * kMs}, 777 * kMs);
  EXPECT_EQ(clock.offset()->ahead_ns, 777 * kMs);
  EXPECT_EQ(clock.offset()->error_ns, 3 * kMs);
}

TEST(ServerClock, isNeverFurtherOffThanItSays) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int64_t> way_ns(0, 20 * kMs);
  std::uniform_int_distribution<int64_t> epoch_ns(-(int64_t{1} << 60), int64_t{1} << 60);
  for (int i = 0; i < 1000; ++i) {
    ServerClock clock;
    const int64_t asked_ns = epoch_ns(random) / 2;
    const int64_t ahead_ns = epoch_ns(random) / 2;
    ask(clock, {asked_ns, way_ns(random), way_ns(random)}, ahead_ns);
    ASSERT_TRUE(clock.offset().has_value());
    EXPECT_LE(std::abs(clock.offset()->ahead_ns - ahead_ns), clock.offset()->error_ns);
  }
}

TEST(ServerClock, trustsTheAnswerThatWasQuickest) {
  ServerClock clock;
  ask(clock, {0, 1 * kMs, 90 * kMs}, 5 * kMs);
  ask(clock, {100 * kMs, kMs / 2, kMs / 4}, 5 * kMs);
  ask(clock, {200 * kMs, 70 * kMs, 1 * kMs}, 5 * kMs);
  EXPECT_EQ(clock.offset()->error_ns, kMs * 3 / 8);
  EXPECT_NEAR(double(clock.offset()->ahead_ns), 5e6, 0.125e6);
}

TEST(ServerClock, forgetsOldAnswersAsClocksDrift) {
  ServerClock clock;
  ask(clock, {0, 0, 0}, 5 * kMs);
  for (size_t i = 1; i < ServerClock::kProbeCount; ++i) ask(clock, {0, kMs, kMs}, 6 * kMs);
  EXPECT_EQ(clock.offset()->ahead_ns, 5 * kMs);
  ask(clock, {0, kMs, kMs}, 6 * kMs);
  EXPECT_EQ(clock.offset()->ahead_ns, 6 * kMs);
  clock.restart();
  EXPECT_EQ(clock.offset(), std::nullopt) << "of another server nothing is known";
}

TEST(ServerClock, leavesOutWhatNoClockCanHaveSaid) {
  ServerClock clock;
  v1::ClockReply reply;
  reply.set_client_time_ns(1000);
  reply.set_server_received_ns(500);
  reply.set_server_sent_ns(400);
  clock.add(reply, 2000);  // sent before it came
  reply.set_server_sent_ns(5000);
  clock.add(reply, 2000);  // longer there than away
  reply.set_server_received_ns(std::numeric_limits<int64_t>::min());
  reply.set_server_sent_ns(std::numeric_limits<int64_t>::max());
  clock.add(reply, 2000);
  reply.set_client_time_ns(std::numeric_limits<int64_t>::min());
  clock.add(reply, 2000);
  EXPECT_EQ(clock.offset(), std::nullopt);
}

TEST(MotionLatency, hasPartsThatAddUp) {
  // Measured at 1000 ms, there after 2 ms, latched after 5 more, made in 20, here after another 3.
  Atlas atlas;
  const ClockOffset server{.ahead_ns = 500 * kMs, .error_ns = 0};
  EXPECT_EQ(motionLatency(atlas, 1000 * kMs, 1030 * kMs, server), std::nullopt);
  atlas.header.set_eye_poses_latched_ns(1507 * kMs);
  atlas.header.set_eye_poses_age_ns(5 * kMs);
  atlas.end.mutable_times()->set_trace_ns(12 * kMs);
  atlas.end.mutable_times()->set_encode_ns(8 * kMs);
  const auto latency = motionLatency(atlas, 1000 * kMs, 1030 * kMs, server);
  ASSERT_TRUE(latency.has_value());
  EXPECT_NEAR(latency->total_s, 0.030, 1e-9);
  EXPECT_NEAR(latency->to_server_s, 0.002, 1e-9);
  EXPECT_NEAR(latency->waited_s, 0.005, 1e-9);
  EXPECT_NEAR(latency->made_s, 0.020, 1e-9);
  EXPECT_NEAR(latency->back_s, 0.003, 1e-9);
}

}  // namespace
}  // namespace viewloom::server_clock_test
