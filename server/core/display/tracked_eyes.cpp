// SPDX-License-Identifier: Apache-2.0
#include "display/tracked_eyes.h"

#include <glm/common.hpp>

#include "base/check.h"
#include "base/str_cat.h"
#include "display/focal_window.h"

namespace viewloom {
namespace {

std::string fieldOfEye(size_t eye) {
  return strCat("eye_poses.eyes[", eye, "]");
}

Camera cameraOf(const TrackedEye& eye, const FocalWindow& window, SizePx eye_size_px) {
  if (!eye.projection) return cameraThroughWindow(window, eye.pose.position_m, eye_size_px);
  const auto* fov = std::get_if<Fov>(&*eye.projection);
  return {.pose = eye.pose,
          .intrinsics = fov != nullptr ? intrinsicsFromFov(*fov, eye_size_px)
                                       : std::get<Intrinsics>(*eye.projection)};
}

}  // namespace

bool isTracked(const DisplaySpec& spec) {
  const auto* stereo = std::get_if<StereoSpec>(&spec.kind);
  return stereo != nullptr && stereo->is_tracked;
}

size_t trackedEyeCount(const DisplaySpec& spec) {
  return eyeCount(std::get<StereoSpec>(spec.kind));
}

absl::Status validateInFront(const EyePoses& poses, double focal_distance_m) {
  for (size_t i = 0; i < poses.eyes.size(); ++i) {
    const TrackedEye& eye = poses.eyes[i];
    if (eye.projection || eye.pose.position_m.z > -focal_distance_m) continue;
    return invalidField(fieldOfEye(i) + ".pose.position.z",
                        strCat("the eye is at z = ", eye.pose.position_m.z,
                               " m, on or behind the focal plane; accepted is more than ",
                               -focal_distance_m, " m, or an eye with fov or intrinsics"));
  }
  return absl::OkStatus();
}

absl::Status placeEyes(const EyePoses& poses, const StereoSpec& stereo,
                       const StreamDefaults& defaults, AtlasLayout& layout) {
  VIEWLOOM_CHECK(poses.eyes.size() == eyeCount(stereo));
  VIEWLOOM_RETURN_IF_ERROR(validateInFront(poses, layout.focal_distance_m));
  const FocalWindow window =
      focalWindow(layout.focal_distance_m, stereo.fov_y_rad, layout.aspect, defaults);
  layout.views.clear();
  for (size_t i = 0; i < poses.eyes.size(); ++i) {
    const Camera camera = cameraOf(poses.eyes[i], window, stereo.eye_size_px);
    if (!validateIntrinsics(camera.intrinsics, "").ok()) {
      return invalidField(fieldOfEye(i) + ".pose.position",
                          "the eye has no finite view of the display; accepted is an eye further "
                          "from the focal plane, or less far aside");
    }
    layout.views.push_back({camera});
  }
  layout.view_pitch_m = glm::dvec2(0);
  if (poses.eyes.size() == 1) return absl::OkStatus();
  const glm::dvec3 beside_m = poses.eyes[1].pose.position_m - poses.eyes[0].pose.position_m;
  layout.view_pitch_m = glm::abs(glm::dvec2(beside_m));
  return absl::OkStatus();
}

}  // namespace viewloom
