// SPDX-License-Identifier: Apache-2.0
// A frame on its way through the intake: while it waits, and while it is decoded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "decode/frame_assembly.h"
#include "decode/frame_decoder.h"
#include "frame/frame_sink.h"

namespace viewloom {

struct WaitingFrame {
  CollectedFrame collected;
  FrameTimes times;
  ReportFrame report;
  std::function<void()> on_taken;
};

// Frames of more px than this take longer than others should wait.
inline constexpr uint64_t kLargeFrame_px = uint64_t{1} << 20;

inline bool isLarge(const FrameFormat& format) {
  uint64_t px_count = 0;
  for (const SourceFormat& source : format.sources) {
    for (const LayerFormat& layer : source.layers) {
      px_count += std::max(layer.depth.size_px.area(), layer.color.size_px.area());
    }
  }
  return px_count > kLargeFrame_px;
}

// A frame in the hands of the threads. Each plane is decoded by whoever claims it; what decoded[i]
// holds is seen by the thread that ends the last plane.
struct OpenFrame {
  // Memory may run out here, so that the frame follows by begin().
  OpenFrame(FrameOrigin from, const FrameFormat& format)
      : origin(std::move(from)),
        planes(wirePlanes(format)),
        decoded(planes.size()),
        is_large(isLarge(format)),
        unfinished_count(planes.size()) {}

  // Formats of planes stay where they are when their frame is moved.
  void begin(WaitingFrame waiting) {
    spent_ns = waiting.collected.arrival_ns;
    frame = std::move(waiting);
  }

  const FrameOrigin origin;
  WaitingFrame frame;
  const std::vector<const PlaneFormat*> planes;
  DecodedPlanes decoded;
  const bool is_large;
  size_t claimed_count = 0;  // guarded by the intake's mutex, as the next
  size_t unfinished_count;
  int64_t spent_ns = 0;  // CPU time of its planes, their arrival included
};

}  // namespace viewloom
