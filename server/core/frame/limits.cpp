// SPDX-License-Identifier: Apache-2.0
#include "frame/limits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/str_cat.h"
#include "frame/cube_map.h"
#include "frame/depth.h"
#include "frame/plane_encoding.h"
#include "frame/validate_plane.h"

namespace viewloom {
namespace {

constexpr double kExposureMaxEv = 32;

std::string planePath(size_t layer, const LayerFormat& format, PlaneKind kind) {
  const bool second = (kind == PlaneKind::kColor) == format.depth_first;
  return strCat("layers[", layer, "].planes[", second ? 1 : 0, "]");
}

// Checks the data needed to draw things that move by themselves at another time.
absl::Status validateMotion(const SourceFormat& source, size_t layer) {
  const LayerFormat& format = source.layers[layer];
  const PlaneFormat& first = source.layers.front().color;
  const auto is_like_first = [&](const LayerFormat& other) {
    return other.color.size_px == other.depth.size_px && other.color.transfer == first.transfer &&
           other.color.primaries == first.primaries && other.color.alpha == first.alpha;
  };
  const auto motion =
      std::find_if(format.others.begin(), format.others.end(),
                   [](const PlaneFormat& plane) { return plane.kind == PlaneKind::kMotion; });
  if (motion == format.others.end()) return absl::OkStatus();
  const bool is_served =
      !source.is_cube_map && std::all_of(source.layers.begin(), source.layers.end(), is_like_first);
  if (is_served) return absl::OkStatus();
  return fieldError(
      absl::StatusCode::kUnimplemented,
      strCat("layers[", layer, "].planes[", 2 + (motion - format.others.begin()), "].kind"),
      source.is_cube_map ? "MOTION of cube maps is not served yet; leave the plane out"
                         : "MOTION is not served yet where colour has another size than depth, or "
                           "where layers differ in transfer, primaries or alpha; make them alike, "
                           "or leave the plane out");
}

// Beside colour and depth; they lie on the facets, too.
absl::Status validateOthers(const LayerFormat& layer, bool is_cube_map, const FrameLimits& limits) {
  for (size_t i = 0; i < layer.others.size(); ++i) {
    const PlaneFormat& plane = layer.others[i];
    const std::string path = strCat("planes[", i + 2, "]");
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(
        validatePlane(plane, plane.kind, is_cube_map, limits.plane_side_px_max), path));
    if (plane.size_px != layer.depth.size_px) {
      return invalidField(path + ".size", strCat("the plane has ", sizeText(plane.size_px),
                                                 " px; accepted is the size of the depth plane, ",
                                                 sizeText(layer.depth.size_px)));
    }
  }
  return absl::OkStatus();
}

// Planes of one source must fit each other: they become one structure.
absl::Status validateAgreement(const SourceFormat& source, size_t layer) {
  const LayerFormat& first = source.layers.front();
  const LayerFormat& format = source.layers[layer];
  if (format.depth.size_px != first.depth.size_px) {
    return invalidField(
        strCat(planePath(layer, format, PlaneKind::kDepth), ".size"),
        strCat("the depth plane has ", sizeText(format.depth.size_px),
               " px; accepted is the size in the first layer, ", sizeText(first.depth.size_px)));
  }
  const auto is_half = [](const LayerFormat& l) {
    return l.color.encoding == PlaneEncoding::kRgba16f;
  };
  if (is_half(format) != is_half(first)) {
    return invalidField(strCat(planePath(layer, format, PlaneKind::kColor), ".encoding"),
                        "the layers mix RGBA16F and 8-bit colour; accepted is one of the two for "
                        "all layers of a source");
  }
  if (source.is_cube_map && format.color.size_px != first.depth.size_px) {
    return invalidField(
        strCat(planePath(layer, format, PlaneKind::kColor), ".size"),
        strCat("the colour plane of a cube map has ", sizeText(format.color.size_px),
               " px; accepted is the size of its depth plane, ", sizeText(first.depth.size_px)));
  }
  return absl::OkStatus();
}

absl::Status validateSource(const SourceFormat& source, const FrameLimits& limits) {
  VIEWLOOM_RETURN_IF_ERROR(validatePose(source.camera.pose, "camera.pose"));
  VIEWLOOM_RETURN_IF_ERROR(validateIntrinsics(source.camera.intrinsics, "camera.intrinsics"));
  if (source.layers.empty() || source.layers.size() > limits.layer_count_max) {
    return invalidField("layers", strCat("the source has ", source.layers.size(),
                                         " layers; accepted is 1..", limits.layer_count_max));
  }
  for (size_t layer = 0; layer < source.layers.size(); ++layer) {
    const LayerFormat& format = source.layers[layer];
    for (const PlaneKind kind : {PlaneKind::kColor, PlaneKind::kDepth}) {
      const PlaneFormat& plane = kind == PlaneKind::kColor ? format.color : format.depth;
      VIEWLOOM_RETURN_IF_ERROR(
          withFieldPrefix(validatePlane(plane, kind, source.is_cube_map, limits.plane_side_px_max),
                          planePath(layer, format, kind)));
    }
    VIEWLOOM_RETURN_IF_ERROR(validateAgreement(source, layer));
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(validateOthers(format, source.is_cube_map, limits),
                                             strCat("layers[", layer, "]")));
    VIEWLOOM_RETURN_IF_ERROR(validateMotion(source, layer));
  }
  const double tolerance = source.connection_tolerance;
  if (!(tolerance >= 0 && tolerance <= double{kInvZMax})) {
    return invalidField("connection_tolerance", strCat("the tolerance is ", tolerance,
                                                       " 1/m; accepted is 0..", double{kInvZMax}));
  }
  return absl::OkStatus();
}

uint64_t heldBytes(const PlaneFormat& plane) {
  return std::max(decodedBytes(plane), plane.wire_bytes);
}

uint64_t heldBytes(const LayerFormat& layer) {
  uint64_t held_bytes = heldBytes(layer.color) + heldBytes(layer.depth);
  for (const PlaneFormat& plane : layer.others) held_bytes += heldBytes(plane);
  return held_bytes + (layer.mirrors() ? layer.depth.size_px.area() * kSurfaceTexelBytes : 0);
}

}  // namespace

uint64_t jpegBytesMax(uint64_t area_px) {
  // Three channels of 8x8 blocks whose 64 coefficients take at most 27 bits each, doubled by byte
  // stuffing; 1 MiB for metadata segments.
  return area_px * 3 * 27 * 2 / 8 + (1 << 20);
}

uint64_t h264BytesMax(SizePx size_px) {
  // A macroblock takes up to 3200 bits (A.3.1), and bytes that keep start codes apart add up to a
  // half; 64 KiB for parameter sets and supplements.
  constexpr uint64_t kMacroblock_px = 16;
  constexpr uint64_t kMacroblockBytes = 3200 / 8 * 3 / 2;
  const auto macroblocks = [](uint64_t side_px) {
    return (side_px + kMacroblock_px - 1) / kMacroblock_px;
  };
  // Each picture has whole macroblocks; a plane in pictures of the least height has twice as many.
  return 2 * macroblocks(size_px.width) * macroblocks(size_px.height) * kMacroblockBytes +
         (1 << 16);
}

uint64_t wireRowBytes(const PlaneFormat& plane) {
  if (plane.stride_bytes != 0) return plane.stride_bytes;
  return uint64_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
}

uint64_t uncompressedBytes(const PlaneFormat& plane) {
  return wireRowBytes(plane) * plane.size_px.height;
}

uint64_t decodedBytes(const PlaneFormat& plane) {
  const uint64_t pixel_bytes = becomesRgba8(plane.encoding) ? 4 : wirePixelBytes(plane.encoding);
  return plane.size_px.area() * pixel_bytes;
}

absl::Status validateFrame(const FrameFormat& format, const FrameLimits& limits) {
  if (format.number == 0)
    return invalidField("header.number", "the number of the frame is 0; accepted is 1 or more");
  if (!(std::abs(format.exposure_ev) <= kExposureMaxEv)) {
    return invalidField("header.exposure_ev", strCat("the exposure is ", format.exposure_ev,
                                                     " stops; accepted is -32..32"));
  }
  const size_t source_count = format.sources.size();
  if (source_count == 0 || source_count > limits.source_count_max) {
    return invalidField("header.sources",
                        strCat("the frame has ", source_count, " sources; accepted is 1..",
                               limits.source_count_max));
  }
  uint64_t held_bytes = 0;
  for (size_t i = 0; i < source_count; ++i) {
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(validateSource(format.sources[i], limits),
                                             strCat("header.sources[", i, "]")));
    for (const LayerFormat& layer : format.sources[i].layers) {
      held_bytes += heldBytes(layer);
    }
  }
  if (held_bytes > limits.frame_bytes_max) {
    return fieldError(absl::StatusCode::kResourceExhausted, "header",
                      strCat("the planes of the frame take ", held_bytes,
                             " bytes; accepted is up to ", limits.frame_bytes_max,
                             ". Send smaller planes or fewer layers, or raise the server's "
                             "limits.frame_bytes_max"));
  }
  return absl::OkStatus();
}

}  // namespace viewloom
