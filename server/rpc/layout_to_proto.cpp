// SPDX-License-Identifier: Apache-2.0
#include "rpc/layout_to_proto.h"

#include "base/check.h"
#include "video/h264_parameters.h"

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

v1::BandEncoding bandEncodingToProto(BandEncoding encoding) {
  switch (encoding) {
    case BandEncoding::kJpegPlanes:
      return v1::BAND_ENCODING_JPEG_PLANES;
    case BandEncoding::kJpeg:
      return v1::BAND_ENCODING_JPEG;
    case BandEncoding::kZstd:
      return v1::BAND_ENCODING_ZSTD;
    case BandEncoding::kRaw:
      return v1::BAND_ENCODING_RAW;
    case BandEncoding::kH264:
      return v1::BAND_ENCODING_H264;
    case BandEncoding::kCompactDepth:
      return v1::BAND_ENCODING_COMPACT_DEPTH;
  }
  VIEWLOOM_CHECK(false && "unknown BandEncoding");
  return v1::BAND_ENCODING_UNSPECIFIED;
}

v1::AtlasEncoding encodingToProto(const EncodingSpec& encoding) {
  v1::AtlasEncoding proto;
  proto.set_color(bandEncodingToProto(encoding.color));
  proto.set_jpeg_quality(encoding.jpeg_quality);
  proto.set_chroma(encoding.chroma == Chroma::k444 ? v1::CHROMA_SUBSAMPLING_444
                                                   : v1::CHROMA_SUBSAMPLING_420);
  proto.set_with_depth(encoding.with_depth);
  proto.set_with_mask(encoding.with_mask);
  proto.set_planes(bandEncodingToProto(encoding.planes));
  if (encoding.color != BandEncoding::kH264) return proto;
  proto.set_prediction(isChained(encoding) ? v1::PREDICTION_ACROSS_ATLASES
                                           : v1::PREDICTION_WITHIN_ATLAS);
  proto.set_video_qp(encoding.video_qp);
  proto.set_bits_per_second_max(encoding.bits_per_second_max);
  return proto;
}

v1::AtlasLayout gridToProto(const AtlasLayout& layout) {
  v1::AtlasLayout proto;
  const TileArrangementPx shown = layout.shown();
  *proto.mutable_size() = sizeToProto(shown.size_px);
  proto.set_columns(shown.columns);
  proto.set_rows(shown.rows);
  *proto.mutable_tile_size() = sizeToProto(shown.tile_size_px);
  proto.set_order(shown.order == TileOrder::kBottomLeft ? v1::TILE_ORDER_BOTTOM_LEFT
                                                        : v1::TILE_ORDER_TOP_LEFT);
  proto.set_aspect(layout.aspect);
  proto.set_view_count(static_cast<uint32_t>(layout.views.size()));
  proto.set_padding_right_px(shown.padding_right_px);
  proto.set_padding_top_px(shown.padding_top_px);
  proto.set_view_cone_rad(layout.view_cone_rad);
  proto.set_focal_distance_m(layout.focal_distance_m);
  proto.set_suffix(layout.suffix);
  proto.set_image_count(shown.image_count);
  return proto;
}

namespace {

v1::DepthCodes depthCodesToProto(const AtlasLayout& layout) {
  const DepthCodes& codes = *layout.depth_codes;
  v1::DepthCodes proto;
  proto.set_bits(codes.bits);
  proto.set_inv_z_near(codes.inv_z_near);
  proto.set_inv_z_far(codes.inv_z_far);
  proto.set_black_near(codes.is_black_near);
  for (uint32_t view = 0; view < layout.views.size(); ++view) {
    if (layout.views[view].shows_depth) proto.add_depth_views(view);
  }
  return proto;
}

v1::VideoStack stackToProto(const VideoStack& stack) {
  v1::VideoStack proto;
  proto.set_picture_count(stack.picture_count);
  *proto.mutable_picture_size() = sizeToProto(stack.pictureSize());
  proto.set_columns(stack.columns);
  proto.set_rows(stack.rows);
  *proto.mutable_cell_size() = sizeToProto(stack.cell_px);
  proto.set_codec_string(codedVideoString(stack.pictureSize()));
  proto.set_color_matrix(v1::COLOR_MATRIX_BT601);
  proto.set_full_range(true);
  return proto;
}

}  // namespace

v1::AtlasLayout layoutToProto(const AtlasLayout& layout, const EncodingSpec& encoding) {
  v1::AtlasLayout proto = gridToProto(layout);
  *proto.mutable_encoding() = encodingToProto(encoding);
  if (layout.depth_codes) *proto.mutable_depth_codes() = depthCodesToProto(layout);
  if (layout.stack) *proto.mutable_video() = stackToProto(*layout.stack);
  proto.set_video_rung(rungNumber(encoding));
  for (const View& view : layout.views) *proto.add_views() = cameraToProto(view.camera);
  return proto;
}

}  // namespace viewloom
