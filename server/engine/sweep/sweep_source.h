// SPDX-License-Identifier: Apache-2.0
// The first source of a frame, ready to be swept.
#pragma once

#include "base/worker_pool.h"
#include "sweep/surface_row_builder.h"

namespace viewloom {

// Whether such frames can be swept: all colour is opaque 8-bit sRGB, a px for each of depth.
bool canSweep(const Frame& frame);
bool canSweep(const FrameFormat& format);

// Keeps its memory from frame to frame. Thread-safety: none while it is prepared, then immutable.
class SweepSource {
 public:
  // Takes over a frame that can be swept.
  void prepare(FramePtr frame, WorkerPool& workers);

  const Frame& frame() const { return *frame_; }
  const MeasuredColumns& measured() const { return measured_; }
  const Camera& camera() const { return frame_->format.sources.front().camera; }
  SizePx sizePx() const { return columns_.sizePx(); }
  RowSource rowSource() const;
  // Beside the frame.
  uint64_t sizeBytes() const { return columns_.sizeBytes(); }
  // At most, for frames of this format.
  static uint64_t bytesFor(const FrameFormat& format);

 private:
  // Adds up the histograms of all blocks, made by all workers; of the kind of `empty`.
  template <typename Histogram>
  Histogram measured(const Histogram& empty, WorkerPool& workers) const;
  void smooth(WorkerPool& workers);

  FramePtr frame_;
  DepthColumns columns_;
  MeasuredColumns measured_;
};

}  // namespace viewloom
