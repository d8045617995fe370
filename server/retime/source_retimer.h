// SPDX-License-Identifier: Apache-2.0
// One source of a frame as it looks some time later.
#pragma once

#include <vector>

#include "base/byte_pool.h"
#include "base/worker_pool.h"
#include "frame/frame.h"
#include "retime/edge_light.h"
#include "retime/fresh_grid.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

// What comes into view that no layer holds takes the farther side of its row.
enum class Guesses : uint8_t {
  kStand,    // as far as that is
  kGiveWay,  // behind it, so that whoever knows better what is there is seen before it
};

// Keeps its memory from frame to frame. Thread-safety: none; it shares its work among threads.
class SourceRetimer {
 public:
  // Of the first source of the frame, in which something moves.
  void prepare(FramePtr frame, WorkerPool& workers) {
    surfaces_.prepare(std::move(frame), workers);
  }

  // Its layers so many seconds later (earlier, if negative): depth is DISPARITY in binary32, and
  // where there is no surface abi::kNoSurface; colour as it was encoded. Every column is sorted.
  std::vector<LayerPlanes> retime(double seconds, Guesses guesses, BytePool& pool,
                                  WorkerPool& workers);

 private:
  // What is written of a layer.
  struct Written {
    float* inv_z = nullptr;
    uint8_t* color = nullptr;
    uint8_t* surface = nullptr;  // nullptr: nothing mirrors
  };

  LayerPlanes takeLayer(BytePool& pool, Written& to) const;
  // Returns the sample that most of it is.
  uint32_t writePx(uint32_t px, const Written& to) const;
  uint32_t blendPx(uint32_t px, const Written& to) const;
  void fillRow(uint32_t y, Guesses guesses, const Written& to);

  MovedSurfaces surfaces_;
  FreshGrid grid_;
  EdgeLight edges_;
  std::vector<uint32_t> front_samples_;  // [px], of the first layer
};

}  // namespace viewloom
