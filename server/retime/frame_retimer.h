// SPDX-License-Identifier: Apache-2.0
// A frame as it looks some time before or after it was captured, by what its planes of motion say.
#pragma once

#include <vector>

#include "base/byte_pool.h"
#include "base/worker_pool.h"
#include "frame/frame.h"
#include "retime/source_retimer.h"

namespace viewloom {

// Keeps its memory, and what it has made of the last frame. Thread-safety: none; it shares its work
// among threads.
class FrameRetimer {
 public:
  explicit FrameRetimer(WorkerPool& workers) : workers_(workers) {}

  // The frame as an upload takes it, seen by its own cameras, with everything that moves where it
  // is `seconds` later. Of sources in which nothing moves it shares the planes.
  FramePtr retime(
      const FramePtr& frame, double seconds, Guesses guesses = Guesses::kStand,
      const BetweenSteps& between_steps = [] {});

 private:
  // Planes of two frames that are traced while a third is made: depth, colour and how they mirror,
  // of all layers of all sources.
  static constexpr size_t kKeptPlanes = 3 * 3 * 4 * 8;

  WorkerPool& workers_;
  BytePool pool_{kKeptPlanes};
  FramePtr prepared_;
  std::vector<SourceRetimer> sources_;  // of the prepared frame; those that stand are not used
};

}  // namespace viewloom
