// SPDX-License-Identifier: Apache-2.0
// Tracked displays of a whole pipeline: how long eye poses wait for the picture that they see.
#pragma once

#include <cstdint>
#include <memory>

#include "frame/frame.h"
#include "gpu/device.h"
#include "load/percentiles.h"
#include "publish/broadcaster.h"

namespace viewloom::bench {

// How the heads move.
enum class HeadMotion : uint8_t {
  kAside,  // to the sides alone: eyes stay in the source's rows
  kFree,   // in all directions, turning: every view needs the walk
};

struct EyeLoad {
  uint32_t viewer_count = 1;
  double rate_hz = 90;          // of each viewer's poses
  bool is_all_at_once = false;  // all heads move at one instant; else each at its own
  HeadMotion motion = HeadMotion::kFree;
  SizePx eye_px{960, 540};
  // Size of a quilt on the same stream, traced again and again; 0x0 = none.
  SizePx quilt_px{0, 0};
  double seconds = 5;
};

struct EyeFigures {
  load::Percentiles answered;  // poses in, until the last band of their picture was packed
  load::Percentiles waited;    // of that, until the first rays were submitted
  load::Percentiles made;      // traced and encoded
  uint64_t quilt_count = 0;
};

// Where a head is at a time, and its two eyes, 63 mm apart.
EyePoses headAt(HeadMotion motion, double time_s);

// On a pipeline with the options of a server. Frames are two of one stream, which differ: without a
// quilt the first stands; with one they come in turn, as soon as it was packed.
EyeFigures measureEyes(const Device& device, const std::vector<FramePtr>& frames,
                       const EyeLoad& load);

}  // namespace viewloom::bench
