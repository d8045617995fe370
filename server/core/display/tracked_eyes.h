// SPDX-License-Identifier: Apache-2.0
// Eyes in front of a tracked stereo display: their places, and what they see.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// An eye, relative to the display. Without a projection it frames the display's rectangle on the
// focal plane, in whatever direction it looks. With a projection it sees just that, in pixels of an
// eye's image.
struct TrackedEye {
  Pose pose;
  std::optional<std::variant<Fov, Intrinsics>> projection;
};

// See proto viewloom.v1.EyePoses. The times of the client are only echoed.
struct EyePoses {
  int64_t time_ns = 0;
  int64_t predicted_display_time_ns = 0;
  int64_t received_ns = 0;  // the server's monotonic clock
  // Left, right; of a display of one eye, that one.
  std::vector<TrackedEye> eyes = std::vector<TrackedEye>(2);
};

using EyePosesPtr = std::shared_ptr<const EyePoses>;

bool isTracked(const DisplaySpec& spec);
// How many eyes a tracked display has: 1 or 2.
size_t trackedEyeCount(const DisplaySpec& spec);

// Checks that eyes without a projection stand in front of the focal plane. INVALID_ARGUMENT names
// the field as "eye_poses.eyes[1].pose.position.z".
absl::Status validateInFront(const EyePoses& poses, double focal_distance_m);

// Replaces the views of the layout by the eyes. Each has an off-axis frustum through the rectangle
// that the display frames without tracked eyes. (R. Kooima, "Generalized Perspective Projection",
// 2009, for a screen parallel to all coordinates.) Expects the layout of a completed spec. Errors
// as above, also for eyes so far aside or so close that their view is not finite. Expects as many
// eyes as the display has.
absl::Status placeEyes(const EyePoses& poses, const StereoSpec& stereo,
                       const StreamDefaults& defaults, AtlasLayout& layout);

}  // namespace viewloom
