// SPDX-License-Identifier: Apache-2.0
// How far the server's clock is ahead of this process's, from what it says when asked.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Monotonic; the clock of all probes, and of whatever is compared with the server's.
int64_t steadyNowNs();

struct ClockOffset {
  int64_t ahead_ns = 0;  // server's time = ours + that
  int64_t error_ns = 0;  // at most: half of what the way there and back took, whichever was longer
};

// Answers that waited somewhere tell little: of the last kProbeCount the one counts that was on its
// way for the shortest time. Older ones are forgotten, since clocks drift apart.
// Thread-safety: none; one owner.
class ServerClock {
 public:
  static constexpr size_t kProbeCount = 16;

  // It came at that time. What no clock can have said is left out.
  void add(const v1::ClockReply& reply, int64_t received_ns);
  // A new connection may lead to another server.
  void restart() { *this = {}; }

  // None before the first answer.
  std::optional<ClockOffset> offset() const;

 private:
  std::array<std::optional<ClockOffset>, kProbeCount> last_;
  size_t next_ = 0;
};

}  // namespace viewloom
