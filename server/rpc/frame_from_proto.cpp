// SPDX-License-Identifier: Apache-2.0
#include "rpc/frame_from_proto.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/str_cat.h"
#include "frame/cube_map.h"
#include "messages/enum_from_proto.h"
#include "messages/source_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::PlaneKind, PlaneKind> kKinds[] = {
    {v1::PLANE_KIND_COLOR, PlaneKind::kColor},
    {v1::PLANE_KIND_DEPTH, PlaneKind::kDepth},
    {v1::PLANE_KIND_MOTION, PlaneKind::kMotion},
    {v1::PLANE_KIND_NORMAL, PlaneKind::kNormal},
    {v1::PLANE_KIND_ROUGHNESS, PlaneKind::kRoughness},
    {v1::PLANE_KIND_SPECULAR, PlaneKind::kSpecular}};

constexpr EnumRow<v1::PlaneEncoding, PlaneEncoding> kEncodings[] = {
    {v1::PLANE_ENCODING_RGBA8, PlaneEncoding::kRgba8},
    {v1::PLANE_ENCODING_RGB8, PlaneEncoding::kRgb8},
    {v1::PLANE_ENCODING_RGBA16F, PlaneEncoding::kRgba16f},
    {v1::PLANE_ENCODING_JPEG, PlaneEncoding::kJpeg},
    {v1::PLANE_ENCODING_H264, PlaneEncoding::kH264},
    {v1::PLANE_ENCODING_DEPTH_F32, PlaneEncoding::kDepthF32},
    {v1::PLANE_ENCODING_DEPTH_F16, PlaneEncoding::kDepthF16},
    {v1::PLANE_ENCODING_DEPTH_U16, PlaneEncoding::kDepthU16},
    {v1::PLANE_ENCODING_XYZ16F, PlaneEncoding::kXyz16f},
    {v1::PLANE_ENCODING_XYZ8, PlaneEncoding::kXyz8},
    {v1::PLANE_ENCODING_OCT16, PlaneEncoding::kOct16},
    {v1::PLANE_ENCODING_R8, PlaneEncoding::kR8}};

constexpr EnumRow<v1::PlaneCompression, PlaneCompression> kCompressions[] = {
    {v1::PLANE_COMPRESSION_UNSPECIFIED, PlaneCompression::kNone},
    {v1::PLANE_COMPRESSION_NONE, PlaneCompression::kNone},
    {v1::PLANE_COMPRESSION_ZSTD, PlaneCompression::kZstd},
    {v1::PLANE_COMPRESSION_PREDICTED_ZSTD, PlaneCompression::kPredictedZstd}};

constexpr EnumRow<v1::ColorTransfer, ColorTransfer> kTransfers[] = {
    {v1::COLOR_TRANSFER_SRGB, ColorTransfer::kSrgb},
    {v1::COLOR_TRANSFER_LINEAR, ColorTransfer::kLinear}};

constexpr EnumRow<v1::ColorPrimaries, ColorPrimaries> kPrimaries[] = {
    {v1::COLOR_PRIMARIES_UNSPECIFIED, ColorPrimaries::kBt709},
    {v1::COLOR_PRIMARIES_BT709, ColorPrimaries::kBt709},
    {v1::COLOR_PRIMARIES_DISPLAY_P3, ColorPrimaries::kDisplayP3},
    {v1::COLOR_PRIMARIES_BT2020, ColorPrimaries::kBt2020}};

constexpr EnumRow<v1::AlphaMode, AlphaMode> kAlphas[] = {
    {v1::ALPHA_MODE_UNSPECIFIED, AlphaMode::kOpaque},
    {v1::ALPHA_MODE_OPAQUE, AlphaMode::kOpaque},
    {v1::ALPHA_MODE_PREMULTIPLIED, AlphaMode::kPremultiplied},
    {v1::ALPHA_MODE_STRAIGHT, AlphaMode::kStraight}};

constexpr EnumRow<v1::NormalSpace, NormalSpace> kNormalSpaces[] = {
    {v1::NORMAL_SPACE_UNSPECIFIED, NormalSpace::kCamera},
    {v1::NORMAL_SPACE_CAMERA, NormalSpace::kCamera},
    {v1::NORMAL_SPACE_WORLD, NormalSpace::kWorld}};

constexpr EnumRow<v1::ToneMap, ToneMap> kToneMaps[] = {{v1::TONE_MAP_UNSPECIFIED, ToneMap::kClip},
                                                       {v1::TONE_MAP_CLIP, ToneMap::kClip},
                                                       {v1::TONE_MAP_FILMIC, ToneMap::kFilmic},
                                                       {v1::TONE_MAP_AGX, ToneMap::kAgx}};

absl::Status colorFromProto(const v1::Plane& proto, PlaneFormat& plane) {
  if (proto.transfer() == v1::COLOR_TRANSFER_UNSPECIFIED) {
    const bool linear = plane.encoding == PlaneEncoding::kRgba16f;
    plane.transfer = linear ? ColorTransfer::kLinear : ColorTransfer::kSrgb;
  } else {
    const auto transfer = enumFromProto(proto.transfer(), "transfer", kTransfers);
    VIEWLOOM_RETURN_IF_ERROR(transfer.status());
    plane.transfer = *transfer;
  }
  const auto primaries = enumFromProto(proto.primaries(), "primaries", kPrimaries);
  VIEWLOOM_RETURN_IF_ERROR(primaries.status());
  const auto alpha = enumFromProto(proto.alpha(), "alpha", kAlphas);
  VIEWLOOM_RETURN_IF_ERROR(alpha.status());
  plane.primaries = *primaries;
  plane.alpha = *alpha;
  return absl::OkStatus();
}

absl::StatusOr<PlaneFormat> planeFromProto(const v1::Plane& proto) {
  const auto kind = enumFromProto(proto.kind(), "kind", kKinds);
  VIEWLOOM_RETURN_IF_ERROR(kind.status());
  const auto encoding = enumFromProto(proto.encoding(), "encoding", kEncodings);
  VIEWLOOM_RETURN_IF_ERROR(encoding.status());
  const auto compression = enumFromProto(proto.compression(), "compression", kCompressions);
  VIEWLOOM_RETURN_IF_ERROR(compression.status());
  PlaneFormat plane;
  plane.kind = *kind;
  plane.encoding = *encoding;
  plane.size_px = sizeFromProto(proto.size());
  plane.stride_bytes = proto.stride_bytes();
  plane.compression = *compression;
  plane.wire_bytes = proto.bytes_count();
  if (plane.kind == PlaneKind::kColor) {
    VIEWLOOM_RETURN_IF_ERROR(colorFromProto(proto, plane));
  } else if (plane.kind == PlaneKind::kNormal) {
    const auto space = enumFromProto(proto.normal_space(), "normal_space", kNormalSpaces);
    VIEWLOOM_RETURN_IF_ERROR(space.status());
    plane.normal_space = *space;
  } else if (plane.kind == PlaneKind::kDepth) {
    const auto depth = depthFormatFromProto(proto.depth());
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(depth.status(), "depth"));
    plane.depth = *depth;
  }
  return plane;
}

absl::Status addPlane(const PlaneFormat& plane, std::optional<PlaneFormat>& color,
                      std::optional<PlaneFormat>& depth, LayerFormat& layer) {
  const bool is_known = plane.kind == PlaneKind::kColor   ? color.has_value()
                        : plane.kind == PlaneKind::kDepth ? depth.has_value()
                                                          : layer.find(plane.kind) != nullptr;
  if (is_known) {
    return invalidField("kind",
                        "the layer has a second plane of this kind; accepted is one of each kind");
  }
  if (plane.kind == PlaneKind::kColor) {
    color = plane;
    layer.depth_first = depth.has_value();
  } else if (plane.kind == PlaneKind::kDepth) {
    depth = plane;
  } else if (!color || !depth) {
    return invalidField("kind",
                        "the plane comes before COLOR and DEPTH; accepted are those two first");
  } else {
    layer.others.push_back(plane);
  }
  return absl::OkStatus();
}

absl::StatusOr<LayerFormat> layerFromProto(const v1::Layer& proto) {
  LayerFormat layer;
  std::optional<PlaneFormat> color;
  std::optional<PlaneFormat> depth;
  for (int i = 0; i < proto.planes_size(); ++i) {
    const std::string path = strCat("planes[", i, "]");
    const auto plane = planeFromProto(proto.planes(i));
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(plane.status(), path));
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(addPlane(*plane, color, depth, layer), path));
  }
  if (!color || !depth) {
    return invalidField("planes", strCat("COLOR or DEPTH is missing among ", proto.planes_size(),
                                         " planes; accepted is one of each, first"));
  }
  layer.color = *color;
  layer.depth = *depth;
  layer.color_has_reflections = proto.color_has_reflections();
  return layer;
}

absl::Status projectionOfCubeMap(const v1::Camera& proto, SizePx plane_px, Camera& camera) {
  if (proto.has_fov() || proto.has_intrinsics()) {
    return invalidField(
        proto.has_fov() ? "fov" : "intrinsics",
        "the camera of a cube map has a projection; leave it out, as each face is 90 degrees wide");
  }
  // An empty plane may have any camera: validateFrame refuses its size.
  camera.intrinsics = cubeFaceIntrinsics(std::max(plane_px.width, 1U));
  return absl::OkStatus();
}

absl::Status cameraFromProto(const v1::Source& source, SizePx size_px, Camera& camera) {
  const v1::Camera& proto = source.camera();
  const auto pose = poseFromProto(proto.pose(), "pose");
  VIEWLOOM_RETURN_IF_ERROR(pose.status());
  camera.pose = *pose;
  if (source.cube_map()) return projectionOfCubeMap(proto, size_px, camera);
  const auto projection = projectionFromProto(proto);
  VIEWLOOM_RETURN_IF_ERROR(projection.status());
  const auto* fov = std::get_if<Fov>(&*projection);
  if (fov == nullptr) {
    camera.intrinsics = std::get<Intrinsics>(*projection);
  } else if (size_px.area() != 0) {
    camera.intrinsics = intrinsicsFromFov(*fov, size_px);
  }  // An empty plane has no pixels to measure angles in; validateFrame refuses its size.
  return absl::OkStatus();
}

absl::StatusOr<SourceFormat> sourceFromProto(const v1::Source& proto, const FrameLimits& limits) {
  const auto layer_count = static_cast<uint32_t>(proto.layers_size());
  if (layer_count == 0 || layer_count > limits.layer_count_max) {
    return invalidField("layers", strCat("the source has ", layer_count, " layers; accepted is 1..",
                                         limits.layer_count_max));
  }
  SourceFormat source;
  source.connection_tolerance = proto.connection_tolerance();
  source.is_cube_map = proto.cube_map();
  for (const v1::Layer& layer_proto : proto.layers()) {
    const auto layer = layerFromProto(layer_proto);
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(layer.status(), strCat("layers[", source.layers.size(), "]")));
    source.layers.push_back(*layer);
  }
  const SizePx size_px = source.layers.front().depth.size_px;
  VIEWLOOM_RETURN_IF_ERROR(
      withFieldPrefix(cameraFromProto(proto, size_px, source.camera), "camera"));
  return source;
}

absl::Status validateSourceCount(uint32_t source_count, const FrameLimits& limits) {
  if (source_count > 0 && source_count <= limits.source_count_max) return absl::OkStatus();
  return invalidField("sources", strCat("the frame has ", source_count, " sources; accepted is 1..",
                                        limits.source_count_max));
}

absl::StatusOr<FrameFormat> formatFromProto(const v1::FrameHeader& proto,
                                            const FrameLimits& limits) {
  VIEWLOOM_RETURN_IF_ERROR(
      validateSourceCount(static_cast<uint32_t>(proto.sources_size()), limits));
  const auto tone_map = enumFromProto(proto.tone_map(), "tone_map", kToneMaps);
  VIEWLOOM_RETURN_IF_ERROR(tone_map.status());
  FrameFormat format;
  for (int i = 0; i < proto.sources_size(); ++i) {
    auto source = sourceFromProto(proto.sources(i), limits);
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(source.status(), strCat("sources[", i, "]")));
    format.sources.push_back(*std::move(source));
  }
  format.number = proto.number();
  format.capture_time_ns = proto.capture_time_ns();
  format.exposure_ev = proto.exposure_ev();
  format.tone_map = *tone_map;
  return format;
}

}  // namespace

absl::StatusOr<FrameFormat> frameFormatFromProto(const v1::FrameHeader& proto,
                                                 const FrameLimits& limits) {
  auto format = formatFromProto(proto, limits);
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(format.status(), "header"));
  VIEWLOOM_RETURN_IF_ERROR(validateFrame(*format, limits));
  return format;
}

}  // namespace viewloom
