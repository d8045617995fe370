// SPDX-License-Identifier: Apache-2.0
// What encode threads do next: strips that the device has traced, and pieces of atlases to sweep.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "pipeline/strip_trace.h"
#include "pipeline/sweep_run.h"
#include "pipeline/turns.h"

namespace viewloom {

// A strip whose trace has been submitted. Holding it keeps the slot and the structure from reuse.
struct TracedStrip {
  AtlasRunPtr run;
  uint32_t strip = 0;
  std::shared_ptr<StripTrace> trace;
  uint64_t timeline_value = 0;
  uint32_t gathered_rows = 0;  // of its lens, where the CPU gathers that
};

// A part of an atlas that is swept: rows of its plan, or, once all are swept, a strip to pack.
struct SweepPart {
  SweepRunPtr sweep;
  bool is_strip = false;
  uint32_t index = 0;  // of the piece, or the strip
};

// One of the two.
struct EncodeTask {
  TracedStrip traced;
  SweepPart part;  // without a sweep: the strip
};

// Of several atlases the one that is due soonest goes first, of tracked displays before all others,
// also between two parts of another; the device's strips keep their order, but for those whose lens
// is gathered part by part, and go before sweeps that are due no sooner.
// Thread-safety: all methods may be called from any thread.
class EncodeQueue {
 public:
  explicit EncodeQueue(size_t strip_count_max) : strip_count_max_(strip_count_max) {}

  // Waits for room. Dropped once the queue is closed.
  void push(TracedStrip strip);
  void push(SweepRunPtr sweep);
  // A strip that was popped, of which parts are left: goes on before strips that do not go first.
  void resume(TracedStrip strip);
  // Waits for something to do. Empty once the queue is closed and everything in it is done.
  std::optional<EncodeTask> pop();
  // A piece that was popped is swept.
  void noteSwept(SweepRun& sweep);
  // What was popped is done, and took that long: of a tracked display, or another.
  void noteServed(bool is_tracked, int64_t duration_ns);
  // Nothing more comes in; what is inside is still handed out.
  void close();
  // Lets go of everything inside.
  void clear();

 private:
  // Until there may be something to take; looks out for a while before it sleeps.
  void waitForMore(std::unique_lock<std::mutex>& lock);
  void noteFilled();
  std::optional<EncodeTask> take();
  SweepRunPtr nextSweep() const;
  SweepPart takePart(const SweepRunPtr& sweep);

  const size_t strip_count_max_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  // Changes, under the mutex, whenever there may be something to take where there was nothing.
  std::atomic<uint32_t> fill_count_ = 0;
  uint32_t lookout_count_ = 0;  // of threads that will look at it before they sleep
  std::deque<TracedStrip> strips_;
  std::vector<SweepRunPtr> sweeps_;  // of which parts are left, what goes first in front
  EyesTurn turn_;                    // of those who pop, in ns
  bool is_closed_ = false;
};

}  // namespace viewloom
