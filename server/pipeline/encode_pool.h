// SPDX-License-Identifier: Apache-2.0
// Threads that wait for traced strips, or sweep atlases, and pack them as each display asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "base/byte_pool.h"
#include "encode/band_encoder.h"
#include "gpu/timeline.h"
#include "lens/band_gatherer.h"
#include "pipeline/atlas_publisher.h"
#include "pipeline/encode_queue.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread. push waits when all threads are busy
// and as much waits already as there are slots for.
class EncodePool {
 public:
  EncodePool(const PipelineLinks& links, const Timeline& timeline, AtlasPublisher& publisher,
             uint32_t thread_count, uint32_t queued_count_max);
  ~EncodePool() { stop(); }

  void push(TracedStrip strip) { tasks_.push(std::move(strip)); }
  // Swept by as many threads as come free, then packed by them.
  void push(SweepRunPtr sweep) { tasks_.push(std::move(sweep)); }
  // Packs what was pushed, then ends the threads. From one thread.
  void stop();

 private:
  struct Worker {
    BandEncoder encoder;
    ViewSweeper sweeper;
    BandGatherer gatherer;
  };
  // A strip in host memory.
  struct StripPlanes;

  void run();
  void serve(TracedStrip strip, Worker& worker);
  static bool gatherPiece(TracedStrip& strip, BandGatherer& gatherer);
  void serve(SweepPart part, Worker& worker);
  void encode(AtlasRun& run, const StripPlanes& planes, BandEncoder& encoder);
  void encodeOutput(AtlasRun& run, const StripPlanes& planes, AtlasOutput& output,
                    BandEncoder& encoder);

  const PipelineLinks& links_;
  const Timeline& timeline_;
  AtlasPublisher& publisher_;
  BytePool bytes_;
  EncodeQueue tasks_;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
