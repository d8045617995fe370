// SPDX-License-Identifier: Apache-2.0
// From the motion of eyes to the picture that they see: how long, and where the time went.
#pragma once

#include <cstdint>
#include <optional>

#include "lib/atlas.h"
#include "lib/server_clock.h"

namespace viewloom {

// Seconds; the parts add up to the total. Those of the way are as exact as the clocks are known.
struct MotionLatency {
  double total_s = 0;      // by this process's clock alone
  double to_server_s = 0;  // measured, until the server had them
  double waited_s = 0;     // there, until the first rays were submitted
  double made_s = 0;       // traced and encoded
  double back_s = 0;       // until the picture was here, and shown
};

// How long an atlas took. The eyes were measured at the one time, and it was shown at the other,
// both by steadyNowNs(). None for an atlas without poses.
std::optional<MotionLatency> motionLatency(const Atlas& atlas, int64_t measured_ns,
                                           int64_t shown_ns, const ClockOffset& server);

}  // namespace viewloom
