// SPDX-License-Identifier: Apache-2.0
// The structure of one frame, ready to be traced, and what is known of that frame and its stream.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "display/atlas_layout.h"
#include "display/taken_defaults.h"
#include "frame/depth_spread.h"
#include "frame/frame.h"
#include "frame/stage_times.h"
#include "picture/trace_job.h"
#include "temporal/camera_motion.h"

namespace viewloom {

class FrameForms;
class StreamRetimer;

// Immutable once built. Its slot goes back to the stream's pool with the last reader, so whoever
// has submitted a trace of it holds it until the device is done.
struct ResidentStructure {
  std::string stream;
  // Immutable but for the forms that engines prepare when they first need them, each on its thread.
  std::shared_ptr<const FrameForms> forms;
  uint64_t serial = 0;  // counts the structures of the server, from 1
  uint64_t frame_number = 0;
  int64_t capture_time_ns = 0;      // the publisher's clock
  std::vector<SeenSource> sources;  // a display without a place in the world stands in the first
  StreamDefaults defaults;
  DefaultsTaking taking;  // of those
  SourceStats stats;      // of the first source
  DepthSpread depths;     // likewise
  FrameTimes times;
  int64_t upload_ns = 0;  // duration
  int64_t build_ns = 0;   // duration
  int64_t retime_ns = 0;  // duration; 0 = of the frame as it came
  int64_t built_at_ns = 0;
  // Where surfaces of the frame move by themselves: the frame, and who makes structures of it for
  // other times. Else nullptr.
  FramePtr moving_frame;
  std::shared_ptr<StreamRetimer> retimer;
};

using ResidentPtr = std::shared_ptr<const ResidentStructure>;

// The newest structure of a stream, and how its camera moves.
struct StreamInstant {
  ResidentPtr structure;
  CameraMotion motion;
  // The one before it, from elsewhere, where some display shows what lies between them.
  ResidentPtr before = nullptr;
};

}  // namespace viewloom
