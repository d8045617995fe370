// SPDX-License-Identifier: Apache-2.0
// How the showing goes, as lines of text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lib/server_clock.h"
#include "show/show_settings.h"

namespace viewloom::show {

// Pictures a second, over the last half second or more.
// Thread-safety: none; one owner.
class ShownRate {
 public:
  void count() { ++count_; }
  double perSecond(int64_t now_ns);

 private:
  uint64_t count_ = 0;
  uint64_t counted_ = 0;  // at since_ns_
  int64_t since_ns_ = 0;
  double rate_ = 0;
};

struct ShowStatistics {
  double rate_hz = 0;
  uint64_t dropped_count = 0;       // on the way, and here because a newer one was due
  std::optional<double> latency_s;  // capture to screen; see FrameLatency
  uint64_t frame_number = 0;        // the publisher's
  std::optional<ClockOffset> server_clock;
  bool is_connected = false;
};

std::string describe(const ShowStatistics& statistics, const ShowSettings& settings,
                     const v1::AtlasLayout& layout);

}  // namespace viewloom::show
