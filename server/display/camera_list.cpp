// SPDX-License-Identifier: Apache-2.0
#include "display/camera_list.h"

#include "absl/strings/str_cat.h"

namespace viewloom {

absl::Status validateCameras(const std::vector<ViewCamera>& cameras, const std::string& field) {
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = absl::StrCat(field, "[", i, "]");
    VIEWLOOM_RETURN_IF_ERROR(validatePose(cameras[i].pose, name + ".pose"));
    if (const auto* fov = std::get_if<Fov>(&cameras[i].projection)) {
      VIEWLOOM_RETURN_IF_ERROR(validateFov(*fov, name + ".fov"));
    } else {
      VIEWLOOM_RETURN_IF_ERROR(
          validateIntrinsics(std::get<Intrinsics>(cameras[i].projection), name + ".intrinsics"));
    }
  }
  return absl::OkStatus();
}

std::vector<View> cameraViews(const std::vector<ViewCamera>& cameras, SizePx tile_size_px) {
  std::vector<View> views;
  views.reserve(cameras.size());
  for (const ViewCamera& camera : cameras) {
    const auto* fov = std::get_if<Fov>(&camera.projection);
    views.push_back(
        {Camera{.pose = camera.pose,
                .intrinsics = fov != nullptr ? intrinsicsFromFov(*fov, tile_size_px)
                                             : std::get<Intrinsics>(camera.projection)}});
  }
  return views;
}

}  // namespace viewloom
