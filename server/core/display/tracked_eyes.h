// SPDX-License-Identifier: Apache-2.0
// The eyes before a tracked stereo display: where they are now, and what they see of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

#include "display/atlas_layout.h"

namespace viewloom {

// Relative to the display. Without a projection it frames the display's rectangle on the focal
// plane, however it is turned; with one, that is what it sees, in px of an eye's image.
struct TrackedEye {
  Pose pose;
  std::optional<std::variant<Fov, Intrinsics>> projection;
};

// As proto viewloom.v1.EyePoses. The client's times mean nothing here.
struct EyePoses {
  int64_t time_ns = 0;
  int64_t predicted_display_time_ns = 0;
  int64_t received_ns = 0;         // the server's monotonic clock
  std::array<TrackedEye, 2> eyes;  // left, right
};

using EyePosesPtr = std::shared_ptr<const EyePoses>;

bool isTracked(const DisplaySpec& spec);

// Who frames a rectangle stands in front of it. INVALID_ARGUMENT names the field as
// "eye_poses.eyes[1].pose.position.z".
absl::Status validateInFront(const EyePoses& poses, double focal_distance_m);

// Puts the eyes in the place of the layout's views: an off-axis frustum from each of them through
// one rectangle, that of the display without them (R. Kooima, "Generalized Perspective Projection",
// 2009, for a screen that all coordinates are parallel to). Expects the layout of a completed
// spec. Errors as above, also of eyes so far aside or so close that they see nothing finite.
absl::Status placeEyes(const EyePoses& poses, const StereoSpec& stereo,
                       const StreamDefaults& defaults, AtlasLayout& layout);

}  // namespace viewloom
