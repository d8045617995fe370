// SPDX-License-Identifier: Apache-2.0
// The pinhole camera: spaces as in OpenXR (metres, right-handed, +x right, +y up, -z forward),
// image rows from the top, sample centres at +0.5.
#pragma once

#include <string_view>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// Camera to world: world = orientation * camera + position_m.
struct Pose {
  glm::dvec3 position_m{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z; unit length

  bool operator==(const Pose&) const = default;
};

// Applies `outer` after `inner`: the pose in the world of an object at `inner` inside another one
// at `outer`.
Pose compose(const Pose& outer, const Pose& inner);
Pose inverse(const Pose& pose);

// Signed half angles like XrFovf. Left and down are negative for a centred camera.
struct Fov {
  double left_rad = 0;
  double right_rad = 0;
  double up_rad = 0;
  double down_rad = 0;
};

// Intrinsics in pixels of the image that the camera belongs to.
struct Intrinsics {
  glm::dvec2 focal_px{1.0};
  glm::dvec2 principal_px{0.0};

  bool operator==(const Intrinsics&) const = default;
};

struct Camera {
  Pose pose;
  Intrinsics intrinsics;

  bool operator==(const Camera&) const = default;
};

Intrinsics intrinsicsFromFov(const Fov& fov, SizePx size_px);
Fov fovFromIntrinsics(const Intrinsics& intrinsics, SizePx size_px);

// Check foreign values. Errors name the field relative to `field`. A quaternion that passes has
// unit length to within 1e-3: normalise it before use.
absl::Status validatePose(const Pose& pose, std::string_view field);
absl::Status validateFov(const Fov& fov, std::string_view field);
absl::Status validateIntrinsics(const Intrinsics& intrinsics, std::string_view field);

}  // namespace viewloom
