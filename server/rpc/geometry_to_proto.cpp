// SPDX-License-Identifier: Apache-2.0
#include "rpc/geometry_to_proto.h"

namespace viewloom {

v1::SizePx sizeToProto(SizePx size_px) {
  v1::SizePx proto;
  proto.set_width(size_px.width);
  proto.set_height(size_px.height);
  return proto;
}

v1::Pose poseToProto(const Pose& pose) {
  v1::Pose proto;
  proto.mutable_position()->set_x(pose.position_m.x);
  proto.mutable_position()->set_y(pose.position_m.y);
  proto.mutable_position()->set_z(pose.position_m.z);
  proto.mutable_orientation()->set_x(pose.orientation.x);
  proto.mutable_orientation()->set_y(pose.orientation.y);
  proto.mutable_orientation()->set_z(pose.orientation.z);
  proto.mutable_orientation()->set_w(pose.orientation.w);
  return proto;
}

v1::Fov fovToProto(const Fov& fov) {
  v1::Fov proto;
  proto.set_angle_left_rad(fov.left_rad);
  proto.set_angle_right_rad(fov.right_rad);
  proto.set_angle_up_rad(fov.up_rad);
  proto.set_angle_down_rad(fov.down_rad);
  return proto;
}

v1::Camera cameraToProto(const Camera& camera) {
  v1::Camera proto;
  *proto.mutable_pose() = poseToProto(camera.pose);
  v1::Intrinsics& intrinsics = *proto.mutable_intrinsics();
  intrinsics.set_focal_x_px(camera.intrinsics.focal_px.x);
  intrinsics.set_focal_y_px(camera.intrinsics.focal_px.y);
  intrinsics.set_principal_x_px(camera.intrinsics.principal_px.x);
  intrinsics.set_principal_y_px(camera.intrinsics.principal_px.y);
  return proto;
}

}  // namespace viewloom
