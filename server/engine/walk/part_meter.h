// SPDX-License-Identifier: Apache-2.0
// Keeps a device at work on the parts of atlases, and no more than that ahead of it.
#pragma once

#include <cstdint>
#include <functional>

#include "gpu/submission.h"
#include "walk/device_watch.h"
#include "walk/submission_clock.h"

namespace viewloom {

// Thread-safety: none; the thread's that submits the parts.
class PartMeter {
 public:
  // All of them outlive it.
  PartMeter(Timeline& timeline, DeviceWatch& watch, SubmissionClock& clock)
      : timeline_(timeline), watch_(watch), clock_(clock) {}

  // A part was submitted and will reach this value of the timeline. `then` is told on any thread
  // how long it took, ns. Waits until the device is done with the part before it.
  void note(uint64_t value, std::function<void(int64_t measured_ns)> then);

 private:
  Timeline& timeline_;
  DeviceWatch& watch_;
  SubmissionClock& clock_;
  uint64_t last_value_ = 0;
};

}  // namespace viewloom
