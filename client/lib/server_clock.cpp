// SPDX-License-Identifier: Apache-2.0
#include "lib/server_clock.h"

#include <chrono>

namespace viewloom {
namespace {

// Beyond these a clock of nanoseconds has run for 73 years, and their sums for no more than fits.
constexpr int64_t kTimeMax_ns = int64_t{1} << 61;

bool isTime(int64_t time_ns) {
  return time_ns > -kTimeMax_ns && time_ns < kTimeMax_ns;
}

}  // namespace

int64_t steadyNowNs() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void ServerClock::add(const v1::ClockReply& reply, int64_t received_ns) {
  const int64_t there_ns = reply.server_received_ns();
  const int64_t back_ns = reply.server_sent_ns();
  if (!isTime(there_ns) || !isTime(back_ns) || !isTime(reply.client_time_ns())) return;
  const int64_t away_ns = received_ns - reply.client_time_ns();
  const int64_t on_its_way_ns = away_ns - (back_ns - there_ns);
  if (back_ns < there_ns || on_its_way_ns < 0) return;
  // The mean of both differences, which each may be large: epochs are any.
  const int64_t ahead_ns = there_ns - reply.client_time_ns() - on_its_way_ns / 2;
  last_[next_] = ClockOffset{.ahead_ns = ahead_ns, .error_ns = (on_its_way_ns + 1) / 2};
  next_ = (next_ + 1) % kProbeCount;
}

std::optional<ClockOffset> ServerClock::offset() const {
  std::optional<ClockOffset> best;
  for (const std::optional<ClockOffset>& sample : last_) {
    if (sample && (!best || sample->error_ns < best->error_ns)) best = sample;
  }
  return best;
}

}  // namespace viewloom
