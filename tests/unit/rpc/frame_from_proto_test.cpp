// SPDX-License-Identifier: Apache-2.0
#include "rpc/frame_from_proto.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viewloom::frame_from_proto_test {
namespace {

v1::FrameHeader header() {
  v1::FrameHeader proto;
  proto.set_number(7);
  proto.set_capture_time_ns(-5);
  proto.set_exposure_ev(1.5);
  proto.set_tone_map(v1::TONE_MAP_FILMIC);
  v1::Source& source = *proto.add_sources();
  source.set_connection_tolerance(0.25);
  v1::Intrinsics& intrinsics = *source.mutable_camera()->mutable_intrinsics();
  intrinsics.set_focal_x_px(10);
  intrinsics.set_focal_y_px(11);
  intrinsics.set_principal_x_px(2);
  intrinsics.set_principal_y_px(-3);
  v1::Layer& layer = *source.add_layers();
  v1::Plane& color = *layer.add_planes();
  color.set_kind(v1::PLANE_KIND_COLOR);
  color.set_encoding(v1::PLANE_ENCODING_RGBA8);
  color.mutable_size()->set_width(6);
  color.mutable_size()->set_height(2);
  color.set_bytes_count(6 * 2 * 4);
  v1::Plane& depth = *layer.add_planes();
  depth.set_kind(v1::PLANE_KIND_DEPTH);
  depth.set_encoding(v1::PLANE_ENCODING_DEPTH_U16);
  depth.mutable_size()->set_width(3);
  depth.mutable_size()->set_height(4);
  depth.set_stride_bytes(8);
  depth.set_bytes_count(4 * 8);
  depth.mutable_depth()->set_meaning(v1::DEPTH_MEANING_DISPARITY);
  return proto;
}

v1::Layer& layerOf(v1::FrameHeader& proto) {
  return *proto.mutable_sources(0)->mutable_layers(0);
}

FrameFormat converted(const v1::FrameHeader& proto) {
  const absl::StatusOr<FrameFormat> format = frameFormatFromProto(proto, {});
  EXPECT_TRUE(format.ok()) << format.status();
  return format.value_or(FrameFormat{.sources = {{.layers = {{}}}}});
}

TEST(FrameFromProto, takesEveryNumberOver) {
  const FrameFormat format = converted(header());
  EXPECT_EQ(format.number, 7u);
  EXPECT_EQ(format.capture_time_ns, -5);
  EXPECT_EQ(format.exposure_ev, 1.5);
  EXPECT_EQ(format.tone_map, ToneMap::kFilmic);
  const SourceFormat& source = format.sources.at(0);
  EXPECT_EQ(source.connection_tolerance, 0.25);
  EXPECT_EQ(source.camera.intrinsics.focal_px, glm::dvec2(10, 11));
  EXPECT_EQ(source.camera.intrinsics.principal_px, glm::dvec2(2, -3));
  const LayerFormat& layer = source.layers.at(0);
  EXPECT_EQ(layer.color.size_px, (SizePx{6, 2}));
  EXPECT_EQ(layer.color.wire_bytes, 48u);
  EXPECT_EQ(layer.depth.size_px, (SizePx{3, 4}));
  EXPECT_EQ(layer.depth.stride_bytes, 8u);
  EXPECT_FALSE(layer.depth_first);
}

TEST(FrameFromProto, fillsInTheDefaultsOfTheProto) {
  const LayerFormat layer = converted(header()).sources[0].layers[0];
  EXPECT_EQ(layer.color.compression, PlaneCompression::kNone);
  EXPECT_EQ(layer.color.transfer, ColorTransfer::kSrgb);
  EXPECT_EQ(layer.color.primaries, ColorPrimaries::kBt709);
  EXPECT_EQ(layer.color.alpha, AlphaMode::kOpaque);
  EXPECT_EQ(layer.depth.depth.meaning, DepthMeaning::kDisparity);
  EXPECT_EQ(layer.depth.depth.scale, 1);
  EXPECT_EQ(layer.depth.depth.offset, 0);
  EXPECT_EQ(layer.depth.depth.max_depth, 1);
  EXPECT_FALSE(layer.depth.depth.invalid_value.has_value());
}

TEST(FrameFromProto, readsHalfFloatColorAsLinear) {
  v1::FrameHeader proto = header();
  layerOf(proto).mutable_planes(0)->set_encoding(v1::PLANE_ENCODING_RGBA16F);
  layerOf(proto).mutable_planes(0)->set_bytes_count(6 * 2 * 8);
  EXPECT_EQ(converted(proto).sources[0].layers[0].color.transfer, ColorTransfer::kLinear);
  layerOf(proto).mutable_planes(0)->set_transfer(v1::COLOR_TRANSFER_SRGB);
  EXPECT_EQ(converted(proto).sources[0].layers[0].color.transfer, ColorTransfer::kSrgb);
}

TEST(FrameFromProto, tellsAnInvalidValueOfZeroFromNone) {
  v1::FrameHeader proto = header();
  layerOf(proto).mutable_planes(1)->mutable_depth()->set_invalid_value(0);
  EXPECT_EQ(converted(proto).sources[0].layers[0].depth.depth.invalid_value, 0.0);
}

TEST(FrameFromProto, remembersWhichPlaneComesFirst) {
  v1::FrameHeader proto = header();
  layerOf(proto).mutable_planes()->SwapElements(0, 1);
  const LayerFormat layer = converted(proto).sources[0].layers[0];
  EXPECT_TRUE(layer.depth_first);
  EXPECT_EQ(layer.color.encoding, PlaneEncoding::kRgba8);
  EXPECT_EQ(layer.depth.encoding, PlaneEncoding::kDepthU16);
}

TEST(FrameFromProto, measuresAnglesInPixelsOfTheDepthPlane) {
  v1::FrameHeader proto = header();
  v1::Fov& fov = *proto.mutable_sources(0)->mutable_camera()->mutable_fov();
  fov.set_angle_left_rad(std::atan(-1.0));
  fov.set_angle_right_rad(std::atan(2.0));
  fov.set_angle_up_rad(std::atan(0.5));
  fov.set_angle_down_rad(std::atan(-1.5));
  const Intrinsics intrinsics = converted(proto).sources[0].camera.intrinsics;
  EXPECT_NEAR(intrinsics.focal_px.x, 3 / 3.0, 1e-12);  // 3 px over tangents -1..2
  EXPECT_NEAR(intrinsics.focal_px.y, 4 / 2.0, 1e-12);  // 4 px over tangents -1.5..0.5
  EXPECT_NEAR(intrinsics.principal_px.x, 1.0, 1e-12);  // the axis: a third from the left
  EXPECT_NEAR(intrinsics.principal_px.y, 1.0, 1e-12);  // and a quarter from the top
}

TEST(FrameFromProto, takesNoOrientationAsNoRotation) {
  v1::FrameHeader proto = header();
  proto.mutable_sources(0)->mutable_camera()->mutable_pose()->mutable_orientation();
  proto.mutable_sources(0)->mutable_camera()->mutable_pose()->mutable_position()->set_z(4);
  const Pose pose = converted(proto).sources[0].camera.pose;
  EXPECT_EQ(pose, (Pose{.position_m = {0, 0, 4}}));
}

TEST(FrameFromProto, makesOrientationsOfUnitLength) {
  v1::FrameHeader proto = header();
  v1::Quaternion& q =
      *proto.mutable_sources(0)->mutable_camera()->mutable_pose()->mutable_orientation();
  q.set_y(0.7075);  // six digits and a little more than sqrt(1/2)
  q.set_w(0.7075);
  const glm::dquat orientation = converted(proto).sources[0].camera.pose.orientation;
  EXPECT_NEAR(glm::length(orientation), 1, 1e-15);
  EXPECT_NEAR(orientation.y, std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace viewloom::frame_from_proto_test
