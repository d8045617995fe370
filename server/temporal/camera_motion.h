// SPDX-License-Identifier: Apache-2.0
// How the camera of a stream moves, as its two newest frames tell, and where it is between frames;
// and for how long things have gone on that move by themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "frame/camera.h"
#include "frame/timing.h"

namespace viewloom {

// Where a thing is that a source of the frame shows, and goes with.
struct ThingPose {
  size_t source = 0;  // its index, not that of the first
  Pose pose;          // of the source's camera

  bool operator==(const ThingPose&) const = default;
};

// The view of a display that stands in a source's camera, at one time.
struct ShownInstant {
  int64_t time_ns = 0;  // the publisher's clock
  Timing timing = Timing::kCaptured;
  Pose source_pose;  // of the first source's camera, then
  // For how long what moves by itself goes on at its speed to where it is then, from the newest
  // frame; negative: back from it. 0 where nothing does.
  int64_t carried_ns = 0;
  std::vector<ThingPose> things = {};  // those that move; others are where their frames have them

  // Neither shows anything that the other does not.
  bool looksLike(const ShownInstant& other) const {
    return timing == other.timing && source_pose == other.source_pose &&
           carried_ns == other.carried_ns && things == other.things;
  }
};

// Motion of the camera of a source, from frame to frame.
struct PoseMotion {
  Pose pose;    // of the newest frame
  Pose before;  // of the frame before that
  glm::dvec3 velocity_mps{0.0};
  glm::dvec3 turn_rad_per_s{0.0};  // around its own place; the axis is the world's

  bool isMoving() const { return velocity_mps != glm::dvec3(0) || turn_rad_per_s != glm::dvec3(0); }
};

// A source that shows a thing, and goes with it.
struct ThingMotion {
  size_t source = 0;  // its index, not that of the first
  PoseMotion motion;
};

// Motion at the newest frame; an unknown camera stands still.
struct CameraMotion {
  PoseMotion camera;
  int64_t captured_ns = 0;     // the publisher's clock
  int64_t least_delay_ns = 0;  // the server's clock less the publisher's
  int64_t interval_ns = 0;     // since the frame before; 0 = not known, or a cut
  // By how much a display that shows what lies between two frames is behind: an interval, and what
  // frames take until they can be traced.
  int64_t lag_ns = 0;
  bool things_move = false;         // surfaces of the frame move by themselves
  std::vector<ThingMotion> things;  // those that move

  // Something does, wherever the camera is.
  bool movesThings() const { return things_move || !things.empty(); }
  bool isMoving() const { return movesThings() || camera.isMoving(); }
};

// The camera, and what moves by itself, at `server_ns` of the server's clock, carried on from the
// newest frame. For as long as frames are apart it keeps its speed, which then falls evenly, to
// nothing when the frame is `bridge_ns` old: from there on it is held.
ShownInstant predicted(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns);

// The camera `lag_ns` before that: between the two newest frames. Where the next one is late, it is
// carried on and held as above.
ShownInstant interpolated(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns);

}  // namespace viewloom
