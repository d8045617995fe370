// SPDX-License-Identifier: Apache-2.0
// Measures how far the server's clock is ahead of the clock of this process.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Monotonic time of this process. Probes, and all times compared with the server's, use it.
int64_t steadyNowNs();

struct ClockOffset {
  int64_t ahead_ns = 0;  // server's time = our time + ahead_ns
  int64_t error_ns = 0;  // largest error: half of the time of the round trip
};

// Estimates the offset from answers to probes. Among the last kProbeCount answers, the one with the
// shortest round trip counts, because the others waited somewhere. Older answers are forgotten,
// because clocks drift. Thread-safety: none; one owner.
class ServerClock {
 public:
  static constexpr size_t kProbeCount = 16;

  // Adds a reply that arrived at received_ns. Impossible replies are ignored.
  void add(const v1::ClockReply& reply, int64_t received_ns);
  // Forgets all answers: a new connection may lead to another server.
  void restart() { *this = {}; }

  // Offset of the clocks. Empty before the first answer.
  std::optional<ClockOffset> offset() const;

 private:
  std::array<std::optional<ClockOffset>, kProbeCount> last_;
  size_t next_ = 0;
};

}  // namespace viewloom
