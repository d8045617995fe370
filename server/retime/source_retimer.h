// SPDX-License-Identifier: Apache-2.0
// One source of a frame as it looks some time later.
#pragma once

#include <functional>
#include <vector>

#include "base/byte_pool.h"
#include "base/worker_pool.h"
#include "frame/frame.h"
#include "retime/edge_light.h"
#include "retime/fresh_grid.h"
#include "retime/fresh_layer.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

// Called by the thread that retimes, between two steps, each of which goes through all pixels of a
// layer or a source. It may throw: then nothing more is made.
using BetweenSteps = std::function<void()>;

// Keeps its memory from frame to frame. Thread-safety: none; it shares its work among threads.
class SourceRetimer {
 public:
  // Prepares the first source of the frame in which something moves.
  void prepare(FramePtr frame, WorkerPool& workers) {
    surfaces_.prepare(std::move(frame), workers);
  }

  // Its layers so many seconds later (earlier, if negative): depth is DISPARITY in binary32, and
  // where there is no surface abi::kNoSurface; colour as it was encoded. Every column is sorted.
  std::vector<LayerPlanes> retime(double seconds, Guesses guesses, BytePool& pool,
                                  WorkerPool& workers, const BetweenSteps& between_steps);

 private:
  LayerPlanes takeLayer(BytePool& pool, FreshPlanes& to) const;

  MovedSurfaces surfaces_;
  FreshGrid grid_;
  EdgeLight edges_;
  std::vector<FreshRow> rows_;           // [worker]
  std::vector<uint32_t> front_samples_;  // [px], of the first layer
};

}  // namespace viewloom
