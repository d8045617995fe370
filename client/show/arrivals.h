// SPDX-License-Identifier: Apache-2.0
// Atlases and events that other threads hand to the drawing thread.
#pragma once

#include <atomic>
#include <mutex>

#include "base/status.h"
#include "show/present_queue.h"
#include "show/shown_atlas.h"

namespace viewloom::show {

// Thread-safety: all methods may be called from any thread.
class Arrivals {
 public:
  // Decoded here, all of them in their order; one that cannot be is a failure.
  void take(const Atlas& atlas);
  // The session ends with it.
  void fail(const absl::Status& status);
  absl::Status failed() const;

  PresentQueue<DecodedAtlas>& queue() { return queue_; }
  std::atomic<bool> is_connected = false;

 private:
  PresentQueue<DecodedAtlas> queue_;
  std::mutex decoder_mutex_;
  ColorDecoder decoder_;  // guarded by decoder_mutex_
  mutable std::mutex mutex_;
  absl::Status failure_;  // guarded by mutex_
};

// So that it looks what has come.
void wakeMainThread();

}  // namespace viewloom::show
