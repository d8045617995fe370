// SPDX-License-Identifier: Apache-2.0
// Pictures for a display with an output rate, between the frames of a stream or after the last.
#pragma once

#include <vector>

#include "display/display_spec.h"
#include "frame/frame.h"
#include "frame/timing.h"
#include "retime/frame_retimer.h"
#include "temporal/camera_motion.h"

namespace viewloom {

struct FramesAtHand {
  FramePtr newest;
  FramePtr before;        // nullptr: nothing is known of how the camera moves
  double inv_z_near = 0;  // 1/m, of the nearest surfaces of the newest
};

struct ShownFrame {
  FramePtr frame;    // with everything that moves where it is then; of two frames all sources
  Pose source_pose;  // of the first source's camera, then
  Timing timing = Timing::kCaptured;
};

// A frame with what moves by itself carried on for so long, and things where they are then.
FramePtr carriedFrame(FrameRetimer& retimer, const FramePtr& frame, int64_t carried_ns,
                      const std::vector<ThingPose>& things, Guesses guesses);
// All sources of both, one after the other.
FramePtr joinedFrames(const Frame& newest, const Frame& before);

// Needs spec.temporal. `later_s` after the newest frame was captured; what lies between the two is
// before that: negative. Errors name the option or the field.
absl::StatusOr<ShownFrame> showBetween(const FramesAtHand& frames, const DisplaySpec& spec,
                                       double later_s);

}  // namespace viewloom
