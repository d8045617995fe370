// SPDX-License-Identifier: Apache-2.0
#include "messages/eye_poses_from_proto.h"

#include "base/str_cat.h"
#include "messages/source_from_proto.h"

namespace viewloom {
namespace {

absl::StatusOr<TrackedEye> eyeFromProto(const v1::Camera& proto) {
  TrackedEye eye;
  const auto pose = poseFromProto(proto.pose(), "pose");
  VIEWLOOM_RETURN_IF_ERROR(pose.status());
  eye.pose = *pose;
  if (proto.projection_case() == v1::Camera::PROJECTION_NOT_SET) return eye;
  const auto projection = projectionFromProto(proto);
  VIEWLOOM_RETURN_IF_ERROR(projection.status());
  eye.projection = *projection;
  return eye;
}

}  // namespace

absl::StatusOr<EyePoses> eyePosesFromProto(const v1::EyePoses& proto, size_t eye_count) {
  EyePoses poses{.time_ns = proto.time_ns(),
                 .predicted_display_time_ns = proto.predicted_display_time_ns(),
                 .eyes = std::vector<TrackedEye>(eye_count)};
  if (proto.eyes_size() != int(eye_count)) {
    return invalidField("eye_poses.eyes", strCat("got ", proto.eyes_size(), " eyes; accepted is ",
                                                 eye_count == 1 ? "one" : "two: left, right"));
  }
  for (int i = 0; i < proto.eyes_size(); ++i) {
    const auto eye = eyeFromProto(proto.eyes(i));
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(eye.status(), strCat("eye_poses.eyes[", i, "]")));
    poses.eyes[size_t(i)] = *eye;
  }
  return poses;
}

}  // namespace viewloom
