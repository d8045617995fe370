// SPDX-License-Identifier: Apache-2.0
#include "messages/source_from_proto.h"

#include <optional>

#include "messages/enum_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::DepthMeaning, DepthMeaning> kMeanings[] = {
    {v1::DEPTH_MEANING_PLANAR, DepthMeaning::kPlanar},
    {v1::DEPTH_MEANING_RAY_DISTANCE, DepthMeaning::kRayDistance},
    {v1::DEPTH_MEANING_WINDOW, DepthMeaning::kWindow},
    {v1::DEPTH_MEANING_DISPARITY, DepthMeaning::kDisparity}};

}  // namespace

SizePx sizeFromProto(const v1::SizePx& proto) {
  return {.width = proto.width(), .height = proto.height()};
}

absl::StatusOr<Pose> poseFromProto(const v1::Pose& proto, std::string_view field) {
  Pose pose;
  pose.position_m = {proto.position().x(), proto.position().y(), proto.position().z()};
  const v1::Quaternion& q = proto.orientation();
  const bool given = q.x() != 0 || q.y() != 0 || q.z() != 0 || q.w() != 0;
  if (given) pose.orientation = glm::dquat(q.w(), q.x(), q.y(), q.z());
  VIEWLOOM_RETURN_IF_ERROR(validatePose(pose, field));
  pose.orientation = glm::normalize(pose.orientation);
  return pose;
}

absl::StatusOr<std::variant<Fov, Intrinsics>> projectionFromProto(const v1::Camera& proto) {
  switch (proto.projection_case()) {
    case v1::Camera::kFov: {
      const Fov fov{.left_rad = proto.fov().angle_left_rad(),
                    .right_rad = proto.fov().angle_right_rad(),
                    .up_rad = proto.fov().angle_up_rad(),
                    .down_rad = proto.fov().angle_down_rad()};
      VIEWLOOM_RETURN_IF_ERROR(validateFov(fov, "fov"));
      return fov;
    }
    case v1::Camera::kIntrinsics: {
      const v1::Intrinsics& given = proto.intrinsics();
      const Intrinsics intrinsics{.focal_px = {given.focal_x_px(), given.focal_y_px()},
                                  .principal_px = {given.principal_x_px(), given.principal_y_px()}};
      VIEWLOOM_RETURN_IF_ERROR(validateIntrinsics(intrinsics, "intrinsics"));
      return intrinsics;
    }
    case v1::Camera::PROJECTION_NOT_SET:
      break;
  }
  return invalidField("projection", "the camera has no projection; accepted is fov or intrinsics");
}

absl::StatusOr<DepthFormat> depthFormatFromProto(const v1::DepthFormat& proto) {
  const auto meaning = enumFromProto(proto.meaning(), "meaning", kMeanings);
  VIEWLOOM_RETURN_IF_ERROR(meaning.status());
  DepthFormat depth{.meaning = *meaning,
                    .scale = proto.scale() == 0 ? 1 : proto.scale(),
                    .offset = proto.offset(),
                    .min_depth = proto.min_depth(),
                    .max_depth = proto.max_depth() == 0 ? 1 : proto.max_depth(),
                    .near_z_m = proto.near_z_m(),
                    .far_z_m = proto.far_z_m(),
                    .invalid_value = std::nullopt,
                    .invalid_is_far = proto.invalid_is_far()};
  if (proto.has_invalid_value()) depth.invalid_value = proto.invalid_value();
  return depth;
}

}  // namespace viewloom
