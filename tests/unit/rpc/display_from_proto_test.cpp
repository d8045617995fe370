// SPDX-License-Identifier: Apache-2.0
#include "messages/display_from_proto.h"

#include <gtest/gtest.h>

#include <numbers>

namespace viewloom::display_from_proto_test {
namespace {

DisplaySpec converted(const v1::Display& proto) {
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(proto);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return spec.value_or(DisplaySpec{});
}

TEST(DisplayFromProto, fillsAQuiltFromItsPresetAndWhatOverridesIt) {
  v1::Display proto;
  proto.mutable_quilt()->set_preset("portrait");
  proto.mutable_quilt()->set_rows(3);
  proto.mutable_quilt()->set_focal_distance_m(2);
  const auto quilt = std::get<QuiltSpec>(converted(proto).kind);
  EXPECT_EQ(quilt.columns, 8u);
  EXPECT_EQ(quilt.rows, 3u);
  EXPECT_EQ(quilt.size_px, (SizePx{3360, 3360}));
  EXPECT_EQ(quilt.aspect, 0.75);
  EXPECT_DOUBLE_EQ(quilt.view_cone_rad, 40 * std::numbers::pi / 180);
  EXPECT_EQ(quilt.focal_distance_m, 2);
  EXPECT_EQ(quilt.order, TileOrder::kBottomLeft);
  EXPECT_EQ(quilt.view_count, 24u);
}

TEST(DisplayFromProto, fillsInTheDefaultsOfTheProto) {
  v1::Display proto;
  proto.mutable_stereo()->mutable_eye_size()->set_width(10);
  proto.mutable_stereo()->mutable_eye_size()->set_height(20);
  const DisplaySpec spec = converted(proto);
  const auto& stereo = std::get<StereoSpec>(spec.kind);
  EXPECT_EQ(stereo.layout, StereoLayout::kSideBySide);
  EXPECT_EQ(stereo.eye_size_px, (SizePx{10, 20}));
  EXPECT_EQ(stereo.eye_distance_m, 0.063);
  EXPECT_FALSE(spec.world_pose.has_value());
  EXPECT_EQ(spec.tolerance_px, 0.25);
  EXPECT_EQ(spec.outside_fill, OutsideFill::kBorder);
  EXPECT_EQ(spec.background_rgb, 0u);
}

TEST(DisplayFromProto, takesEveryNumberOver) {
  v1::Display proto;
  v1::CamerasDisplay& cameras = *proto.mutable_cameras();
  cameras.mutable_tile_size()->set_width(3);
  cameras.mutable_tile_size()->set_height(4);
  cameras.set_columns(2);
  cameras.set_order(v1::TILE_ORDER_BOTTOM_LEFT);
  cameras.add_cameras()->mutable_fov()->set_angle_left_rad(-0.1);
  cameras.mutable_cameras(0)->mutable_fov()->set_angle_right_rad(0.2);
  cameras.mutable_cameras(0)->mutable_fov()->set_angle_up_rad(0.3);
  cameras.mutable_cameras(0)->mutable_fov()->set_angle_down_rad(-0.4);
  cameras.mutable_cameras(0)->mutable_pose()->mutable_position()->set_x(5);
  cameras.add_cameras()->mutable_intrinsics()->set_focal_x_px(6);
  cameras.mutable_cameras(1)->mutable_intrinsics()->set_focal_y_px(7);
  proto.mutable_world_pose()->mutable_position()->set_y(8);
  proto.set_tolerance_px(9);
  proto.set_outside_fill(v1::OUTSIDE_FILL_BACKGROUND);
  proto.set_background_rgb(0x0a0b0c);
  const DisplaySpec spec = converted(proto);
  const auto& list = std::get<CamerasSpec>(spec.kind);
  EXPECT_EQ(list.tile_size_px, (SizePx{3, 4}));
  EXPECT_EQ(list.columns, 2u);
  EXPECT_EQ(list.order, TileOrder::kBottomLeft);
  ASSERT_EQ(list.cameras.size(), 2u);
  EXPECT_EQ(list.cameras[0].pose.position_m.x, 5);
  const Fov fov = std::get<Fov>(list.cameras[0].projection);
  EXPECT_EQ(fov.left_rad, -0.1);
  EXPECT_EQ(fov.right_rad, 0.2);
  EXPECT_EQ(fov.up_rad, 0.3);
  EXPECT_EQ(fov.down_rad, -0.4);
  EXPECT_EQ(std::get<Intrinsics>(list.cameras[1].projection).focal_px, glm::dvec2(6, 7));
  ASSERT_TRUE(spec.world_pose.has_value());
  EXPECT_EQ(spec.world_pose->position_m.y, 8);
  EXPECT_EQ(spec.tolerance_px, 9);
  EXPECT_EQ(spec.outside_fill, OutsideFill::kBackground);
  EXPECT_EQ(spec.background_rgb, 0x0a0b0cu);
}

DisplaySpec portrait() {
  v1::Display proto;
  proto.mutable_quilt()->set_preset("portrait");
  return converted(proto);
}

TEST(EncodingFromProto, fillsInTheDefaultsOfTheProto) {
  EXPECT_EQ(*encodingFromProto({}, portrait()), EncodingSpec{});
}

TEST(EncodingFromProto, takesEveryChoiceOver) {
  v1::AtlasEncoding proto;
  proto.set_color(v1::BAND_ENCODING_ZSTD);
  proto.set_jpeg_quality(3);
  proto.set_chroma(v1::CHROMA_SUBSAMPLING_444);
  proto.set_with_depth(true);
  proto.set_with_mask(true);
  proto.set_planes(v1::BAND_ENCODING_RAW);
  EXPECT_EQ(*encodingFromProto(proto, portrait()), (EncodingSpec{.color = BandEncoding::kZstd,
                                                                 .jpeg_quality = 3,
                                                                 .chroma = Chroma::k444,
                                                                 .with_depth = true,
                                                                 .with_mask = true,
                                                                 .planes = BandEncoding::kRaw}));
}

}  // namespace
}  // namespace viewloom::display_from_proto_test
