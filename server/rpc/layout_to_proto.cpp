// SPDX-License-Identifier: Apache-2.0
#include "rpc/layout_to_proto.h"

#include "base/check.h"
#include "rpc/geometry_to_proto.h"

namespace viewloom {

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
  return proto;
}

v1::AtlasLayout gridToProto(const AtlasLayout& layout) {
  v1::AtlasLayout proto;
  *proto.mutable_size() = sizeToProto(layout.size_px);
  proto.set_columns(layout.columns);
  proto.set_rows(layout.rows);
  *proto.mutable_tile_size() = sizeToProto(layout.tile_size_px);
  proto.set_order(layout.order == TileOrder::kBottomLeft ? v1::TILE_ORDER_BOTTOM_LEFT
                                                         : v1::TILE_ORDER_TOP_LEFT);
  proto.set_aspect(layout.aspect);
  proto.set_view_count(static_cast<uint32_t>(layout.views.size()));
  proto.set_padding_right_px(layout.padding_right_px);
  proto.set_padding_top_px(layout.padding_top_px);
  proto.set_view_cone_rad(layout.view_cone_rad);
  proto.set_focal_distance_m(layout.focal_distance_m);
  proto.set_suffix(layout.suffix);
  proto.set_image_count(layout.image_count);
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

}  // namespace

v1::AtlasLayout layoutToProto(const AtlasLayout& layout, const EncodingSpec& encoding) {
  v1::AtlasLayout proto = gridToProto(layout);
  *proto.mutable_encoding() = encodingToProto(encoding);
  if (layout.depth_codes) *proto.mutable_depth_codes() = depthCodesToProto(layout);
  for (const View& view : layout.views) *proto.add_views() = cameraToProto(view.camera);
  return proto;
}

}  // namespace viewloom
