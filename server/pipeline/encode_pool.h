// SPDX-License-Identifier: Apache-2.0
// Threads that finish strips of atlases and pack them as each display asked for.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "base/byte_pool.h"
#include "encode/band_encoder.h"
#include "encode/video_encoders.h"
#include "pipeline/atlas_publisher.h"
#include "pipeline/encode_queue.h"

namespace viewloom {

struct EncodePoolOptions {
  uint32_t thread_count = 1;
  uint32_t video_thread_count = 1;  // that code a picture of a video together
  VideoEncoderChoicePtr video_encoders;
  std::function<void()> on_cores_free = [] {};  // see keepsCores(); called on any thread
};

// Thread-safety: all methods may be called from any thread.
class EncodePool {
 public:
  EncodePool(const PipelineLinks& links, AtlasPublisher& publisher, FairShares& shares,
             const EncodePoolOptions& options);
  ~EncodePool() { stop(); }

  // Finished by as many threads as come free, then packed by them.
  void push(StripBatchPtr batch) { tasks_.push(std::move(batch)); }
  // Whether a device that computes on this machine's cores is to leave them to the threads, rather
  // than begin a part of this claim: they are all busy, and somebody who has had less waits for
  // one. Then on_cores_free says when to ask again.
  bool keepsCores(const Claim& claim);
  // Packs what was pushed, then ends the threads. From one thread.
  void stop();

 private:
  // A strip in host memory.
  struct StripPixels;

  void run();
  void serve(const EncodeTask& task, BandEncoder& encoder);
  void pack(const EncodeTask& task, BandEncoder& encoder);
  void encode(const EncodeTask& task, const StripPixels& strip, BandEncoder& encoder);
  void putIntoVideo(const AtlasRunPtr& run, const EncodeTask& task, const StripPixels& strip);
  void pushCoding(const AtlasRunPtr& run, size_t output);
  void codePicture(const AtlasRunPtr& run, size_t output);
  void finishRows(const AtlasRunPtr& run, uint32_t row_count);
  void note(const EncodeTask& task, int64_t duration_ns);
  void finish(EncodeTask task);

  const PipelineLinks& links_;
  AtlasPublisher& publisher_;
  BytePool bytes_;
  BytePool planes_;  // of pictures that wait to be coded
  VideoEncoders video_encoders_;
  EncodeQueue tasks_;
  const bool has_all_cores_;
  const std::function<void()> on_cores_free_;
  std::atomic<bool> are_cores_awaited_ = false;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
