// SPDX-License-Identifier: Apache-2.0
// Follows the camera of a stream from frame to frame.
#pragma once

#include <optional>
#include <vector>

#include "temporal/camera_motion.h"
#include "temporal/content_motion.h"

namespace viewloom {

// A source that is not the first, as far as it tells of motion.
struct TrackedSource {
  Pose pose;
  // Change since the frame before.
  ContentMotion content = ContentMotion::kUnclear;
};

// A frame as far as it tells of motion.
struct TrackedFrame {
  Pose pose;                               // of the first source's camera
  int64_t captured_ns = 0;                 // the publisher's clock
  int64_t arrived_ns = 0;                  // its first bytes, the server's clock
  int64_t built_ns = 0;                    // since when it can be traced, likewise
  double inv_z_near = 0;                   // 1/m, of its nearest surfaces
  bool things_move = false;                // surfaces of it move by themselves
  std::vector<TrackedSource> others = {};  // the sources after the first
};

// The frame as if it had been there, and built, when it was captured. `before`: the frame before;
// nullptr: there is none. `inv_z_near`: 1/m, of its nearest surfaces.
TrackedFrame trackedFrame(const Frame& frame, const Frame* before, double inv_z_near);

// Frames further apart say nothing of how a camera moves now.
inline constexpr int64_t kTrackedIntervalMax_ns = 2'000'000'000;
// A camera that turns further from one frame to the next has been cut to another.
inline constexpr double kCutTurn_rad = 0.8;
// Within this distance from 0 (73 years), times of any epoch can be told apart without overflow.
inline constexpr int64_t kTrackedTimeMax_ns = int64_t{1} << 61;

// Thread-safety: none.
class CameraTrack {
 public:
  // The next frame. Times that stand or go back, or lie beyond kTrackedTimeMax_ns, begin anew with
  // a camera that stands still; so does one that passes its nearest surfaces, or turns by more than
  // kCutTurn_rad, from one frame to the next: that is a cut. What a source shows that is not the
  // first stands, until it is clear that it goes with its camera; what is clear holds until the
  // opposite is.
  const CameraMotion& add(const TrackedFrame& frame);

 private:
  // How fast the publisher's clock may run away from the server's: the least delay seen grows by so
  // much, until frames with less delay are seen.
  static constexpr double kClockDriftMax = 200e-6;
  // Part of the way to a frame's lag that is gone per frame: a lost frame turns no time back.
  static constexpr int64_t kLagStepsPerFrame = 8;

  void begin(const TrackedFrame& frame);
  void measure(const TrackedFrame& frame);
  void noteThings(const TrackedFrame& frame, int64_t interval_ns, double inv_z_near);

  std::optional<TrackedFrame> last_;
  std::vector<bool> are_things_;  // of the sources after the first
  CameraMotion motion_;
};

}  // namespace viewloom
