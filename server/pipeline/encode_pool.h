// SPDX-License-Identifier: Apache-2.0
// Threads that wait for traced strips and pack them as each display asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "base/bounded_queue.h"
#include "base/byte_pool.h"
#include "encode/band_encoder.h"
#include "gpu/timeline.h"
#include "pipeline/atlas_publisher.h"
#include "pipeline/strip_trace.h"

namespace viewloom {

// A strip whose trace has been submitted. Holding it keeps the slot and the structure from reuse.
struct TracedStrip {
  AtlasRunPtr run;
  uint32_t strip = 0;
  std::shared_ptr<StripTrace> trace;
  uint64_t timeline_value = 0;
};

// Thread-safety: all methods may be called from any thread. push waits when all threads are busy
// and as many strips as there are trace slots wait already.
class EncodePool {
 public:
  EncodePool(const PipelineLinks& links, const Timeline& timeline, AtlasPublisher& publisher,
             uint32_t thread_count, uint32_t queued_count_max);
  ~EncodePool() { stop(); }

  void push(TracedStrip strip) { strips_.push(std::move(strip)); }
  // Packs what was pushed, then ends the threads. From one thread.
  void stop();

 private:
  void run();
  void encode(TracedStrip strip, BandEncoder& encoder);
  void encodeOutput(const TracedStrip& strip, AtlasOutput& output, BandEncoder& encoder);

  const PipelineLinks& links_;
  const Timeline& timeline_;
  AtlasPublisher& publisher_;
  BytePool bytes_;
  BoundedQueue<TracedStrip> strips_;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
