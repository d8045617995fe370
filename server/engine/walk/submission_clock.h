// SPDX-License-Identifier: Apache-2.0
// Measures how long submissions take on a device.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "base/thread_time.h"

namespace viewloom {

// Submissions run one after the other: each from when it was submitted, or the one before was done.
// Times are of wallTimeNs(). Thread-safety: all methods may be called from any thread.
class SubmissionClock {
 public:
  // A submission was seen done just now. Returns how long it took, ns.
  int64_t noteDone(int64_t submitted_ns) {
    const int64_t done_ns = wallTimeNs();
    return done_ns - std::max(submitted_ns, last_done_ns_.exchange(done_ns));
  }

 private:
  std::atomic<int64_t> last_done_ns_ = 0;
};

}  // namespace viewloom
