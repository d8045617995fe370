// SPDX-License-Identifier: Apache-2.0
#include "frame/limits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/str_cat.h"
#include "frame/cube_map.h"
#include "frame/depth.h"
#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

constexpr double kExposureMaxEv = 32;
// A row may be padded up to the next page of this size.
constexpr uint64_t kRowPaddingBytesMax = 65536;
// More than any zstd encoder adds to bytes it cannot compress.
constexpr uint64_t zstdBytesMax(uint64_t content_bytes) {
  return content_bytes + content_bytes / 128 + 1024;
}

absl::Status overLimit(std::string_view field, std::string_view problem) {
  return fieldError(absl::StatusCode::kResourceExhausted, field, problem);
}

std::string sizeText(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height);
}

// Six square faces, one below the other: only the side of one is limited.
absl::Status validateCubeSize(SizePx size_px, uint32_t side_px_max) {
  if (size_px.width == 0 || size_px.height != uint64_t{kCubeFaceCount} * size_px.width) {
    return invalidField("size", strCat("is ", sizeText(size_px), ", must be N x ", kCubeFaceCount,
                                       " N: the faces of a cube map, one below the other"));
  }
  if (size_px.width > side_px_max) {
    return overLimit("size", strCat("has faces of ", size_px.width, " px, at most ", side_px_max,
                                    " px a side are accepted"));
  }
  return absl::OkStatus();
}

absl::Status validateSize(SizePx size_px, uint32_t side_px_max) {
  if (size_px.width == 0 || size_px.height == 0) {
    return invalidField("size", strCat("is ", sizeText(size_px), ", must be at least 1x1"));
  }
  if (std::max(size_px.width, size_px.height) > side_px_max) {
    return overLimit("size", strCat("is ", sizeText(size_px), ", at most ", side_px_max,
                                    " px a side are accepted"));
  }
  return absl::OkStatus();
}

absl::Status validateStride(const PlaneFormat& plane) {
  if (plane.stride_bytes == 0) return absl::OkStatus();
  if (plane.encoding == PlaneEncoding::kJpeg) {
    return invalidField("stride_bytes", strCat("is ", plane.stride_bytes, ", must be 0 for JPEG"));
  }
  const uint64_t packed = uint64_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
  if (plane.stride_bytes < packed || plane.stride_bytes > packed + kRowPaddingBytesMax) {
    return invalidField("stride_bytes", strCat("is ", plane.stride_bytes, ", must be 0 or ", packed,
                                               "..", packed + kRowPaddingBytesMax));
  }
  return absl::OkStatus();
}

// Prediction is between samples of 16 bits that lie side by side.
absl::Status validateCompression(const PlaneFormat& plane) {
  if (plane.compression != PlaneCompression::kPredictedZstd) return absl::OkStatus();
  if (plane.encoding != PlaneEncoding::kDepthU16 && plane.encoding != PlaneEncoding::kDepthF16) {
    return invalidField("compression",
                        "is PREDICTED_ZSTD, which is for DEPTH_U16 and DEPTH_F16 alone");
  }
  if (plane.stride_bytes == 0) return absl::OkStatus();
  return invalidField("stride_bytes",
                      strCat("is ", plane.stride_bytes, ", must be 0 with PREDICTED_ZSTD"));
}

absl::Status validateWireBytes(const PlaneFormat& plane) {
  const uint64_t got = plane.wire_bytes;
  const uint64_t content = uncompressedBytes(plane);
  const bool jpeg = plane.encoding == PlaneEncoding::kJpeg;
  if (plane.compression == PlaneCompression::kNone && !jpeg && got != content) {
    return invalidField("bytes_count", strCat("is ", got, ", must be ", content, " for ",
                                              sizeText(plane.size_px), " and this encoding"));
  }
  uint64_t most = jpeg ? jpegBytesMax(plane.size_px.area()) : content;
  if (plane.compression != PlaneCompression::kNone) most = zstdBytesMax(most);
  most = std::min(most, kPlaneWireBytesMax);
  if (got == 0 || got > most) {
    return invalidField("bytes_count", strCat("is ", got, ", must lie in 1..", most));
  }
  return absl::OkStatus();
}

absl::Status validatePlane(const PlaneFormat& plane, PlaneKind kind, bool is_cube_map,
                           const FrameLimits& limits) {
  if (plane.kind != kind || !isEncodingOf(kind, plane.encoding)) {
    return invalidField("encoding", strCat("is not one of ", encodingsOf(kind)));
  }
  VIEWLOOM_RETURN_IF_ERROR(is_cube_map ? validateCubeSize(plane.size_px, limits.plane_side_px_max)
                                       : validateSize(plane.size_px, limits.plane_side_px_max));
  VIEWLOOM_RETURN_IF_ERROR(validateStride(plane));
  VIEWLOOM_RETURN_IF_ERROR(validateCompression(plane));
  VIEWLOOM_RETURN_IF_ERROR(validateWireBytes(plane));
  if (kind == PlaneKind::kColor) {
    if (!is_cube_map || plane.alpha == AlphaMode::kOpaque) return absl::OkStatus();
    return fieldError(absl::StatusCode::kUnimplemented, "alpha",
                      "is not OPAQUE, which is not served yet for cube maps");
  }
  if (kind != PlaneKind::kDepth) return absl::OkStatus();
  return validateDepthFormat(plane.depth, plane.encoding, "depth");
}

std::string planePath(size_t layer, const LayerFormat& format, PlaneKind kind) {
  const bool second = (kind == PlaneKind::kColor) == format.depth_first;
  return strCat("layers[", layer, "].planes[", second ? 1 : 0, "]");
}

// What things that move by themselves need to be drawn anew elsewhere.
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
      source.is_cube_map ? "is MOTION, which is not served yet for cube maps"
                         : "is MOTION, which is not served yet for colour of another size than "
                           "depth, or of several transfers, primaries or alphas in one source");
}

// Beside colour and depth; they lie on the facets, too.
absl::Status validateOthers(const LayerFormat& layer, bool is_cube_map, const FrameLimits& limits) {
  for (size_t i = 0; i < layer.others.size(); ++i) {
    const PlaneFormat& plane = layer.others[i];
    const std::string path = strCat("planes[", i + 2, "]");
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(validatePlane(plane, plane.kind, is_cube_map, limits), path));
    if (plane.size_px != layer.depth.size_px) {
      return invalidField(path + ".size",
                          strCat("is ", sizeText(plane.size_px), ", must be that of the depth, ",
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
    return invalidField(strCat(planePath(layer, format, PlaneKind::kDepth), ".size"),
                        strCat("is ", sizeText(format.depth.size_px), ", must be that of layer 0, ",
                               sizeText(first.depth.size_px)));
  }
  const auto is_half = [](const LayerFormat& l) {
    return l.color.encoding == PlaneEncoding::kRgba16f;
  };
  if (is_half(format) != is_half(first)) {
    return invalidField(strCat(planePath(layer, format, PlaneKind::kColor), ".encoding"),
                        "mixes RGBA16F with 8-bit colour within one source");
  }
  if (source.is_cube_map && format.color.size_px != first.depth.size_px) {
    return invalidField(
        strCat(planePath(layer, format, PlaneKind::kColor), ".size"),
        strCat("is ", sizeText(format.color.size_px), ", must be that of the cube map's depth, ",
               sizeText(first.depth.size_px)));
  }
  return absl::OkStatus();
}

absl::Status validateSource(const SourceFormat& source, const FrameLimits& limits) {
  VIEWLOOM_RETURN_IF_ERROR(validatePose(source.camera.pose, "camera.pose"));
  VIEWLOOM_RETURN_IF_ERROR(validateIntrinsics(source.camera.intrinsics, "camera.intrinsics"));
  if (source.layers.empty() || source.layers.size() > limits.layer_count_max) {
    return invalidField("layers", strCat("has ", source.layers.size(), " entries, must have 1..",
                                         limits.layer_count_max));
  }
  for (size_t layer = 0; layer < source.layers.size(); ++layer) {
    const LayerFormat& format = source.layers[layer];
    for (const PlaneKind kind : {PlaneKind::kColor, PlaneKind::kDepth}) {
      const PlaneFormat& plane = kind == PlaneKind::kColor ? format.color : format.depth;
      VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(
          validatePlane(plane, kind, source.is_cube_map, limits), planePath(layer, format, kind)));
    }
    VIEWLOOM_RETURN_IF_ERROR(validateAgreement(source, layer));
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(validateOthers(format, source.is_cube_map, limits),
                                             strCat("layers[", layer, "]")));
    VIEWLOOM_RETURN_IF_ERROR(validateMotion(source, layer));
  }
  const double tolerance = source.connection_tolerance;
  if (!(tolerance >= 0 && tolerance <= double{kInvZMax})) {
    return invalidField("connection_tolerance",
                        strCat("is ", tolerance, ", must be finite and not negative"));
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

uint64_t wireRowBytes(const PlaneFormat& plane) {
  if (plane.stride_bytes != 0) return plane.stride_bytes;
  return uint64_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
}

uint64_t uncompressedBytes(const PlaneFormat& plane) {
  return wireRowBytes(plane) * plane.size_px.height;
}

uint64_t decodedBytes(const PlaneFormat& plane) {
  const bool becomes_rgba8 =
      plane.encoding == PlaneEncoding::kRgb8 || plane.encoding == PlaneEncoding::kJpeg;
  const uint64_t pixel_bytes = becomes_rgba8 ? 4 : wirePixelBytes(plane.encoding);
  return plane.size_px.area() * pixel_bytes;
}

absl::Status validateFrame(const FrameFormat& format, const FrameLimits& limits) {
  if (format.number == 0) return invalidField("header.number", "is 0, must be at least 1");
  if (!(std::abs(format.exposure_ev) <= kExposureMaxEv)) {
    return invalidField("header.exposure_ev",
                        strCat("is ", format.exposure_ev, ", must lie in -32..32"));
  }
  const size_t source_count = format.sources.size();
  if (source_count == 0 || source_count > limits.source_count_max) {
    return invalidField("header.sources", strCat("has ", source_count, " entries, must have 1..",
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
    return overLimit("header", strCat("declares ", held_bytes, " bytes of planes, at most ",
                                      limits.frame_bytes_max, " are accepted"));
  }
  return absl::OkStatus();
}

}  // namespace viewloom
