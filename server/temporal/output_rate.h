// SPDX-License-Identifier: Apache-2.0
// Displays with an output rate: when they want their next atlas, and the instant that it shows.
#pragma once

#include <cstdint>
#include <optional>

#include "display/display_spec.h"
#include "temporal/camera_motion.h"

namespace viewloom {

// Ticks at start + n / rate, for ever: one that is late moves none of those after it.
// Thread-safety: none.
class OutputClock {
 public:
  // The first tick is due at `start_ns`, of any clock that does not go back.
  OutputClock(double rate_hz, int64_t start_ns) : rate_hz_(rate_hz), start_ns_(start_ns) {}

  struct Tick {
    int64_t due_ns = 0;
    uint64_t missed_count = 0;  // ticks since the last one taken that nobody has seen
  };

  int64_t dueNs() const { return tickNs(next_); }
  // The newest tick that is due; empty while none is.
  std::optional<Tick> take(int64_t now_ns);

 private:
  // Time of tick `index`, without the accumulated error of a rounded period.
  int64_t tickNs(uint64_t index) const;

  double rate_hz_;
  int64_t start_ns_;
  uint64_t next_ = 0;
};

// The instant that a display is shown at `server_ns` of the server's clock, as spec.temporal asks
// for, which it needs. A display in the world sees the same whatever the camera does.
ShownInstant shownTo(const DisplaySpec& spec, const CameraMotion& motion, int64_t server_ns);

}  // namespace viewloom
