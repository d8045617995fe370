// SPDX-License-Identifier: Apache-2.0
#include "frame/validate_plane.h"

#include <algorithm>

#include "base/str_cat.h"
#include "frame/cube_map.h"
#include "frame/depth.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

// A row may be padded up to the next page of this size.
constexpr uint64_t kRowPaddingBytesMax = 65536;
// More than any zstd encoder adds to bytes it cannot compress.
constexpr uint64_t zstdBytesMax(uint64_t content_bytes) {
  return content_bytes + content_bytes / 128 + 1024;
}

absl::Status overLimit(std::string_view field, std::string_view problem) {
  return fieldError(absl::StatusCode::kResourceExhausted, field, problem);
}

// Six square faces, one below the other: only the side of one is limited.
absl::Status validateCubeSize(SizePx size_px, uint32_t side_px_max) {
  if (size_px.width == 0 || size_px.height != uint64_t{kCubeFaceCount} * size_px.width) {
    return invalidField(
        "size", strCat("a plane of a cube map has ", sizeText(size_px), " px; accepted is N x ",
                       kCubeFaceCount, " N: the faces, one below the other"));
  }
  if (size_px.width > side_px_max) {
    return overLimit("size", strCat("a face of the cube map has ", size_px.width,
                                    " px a side; accepted is up to ", side_px_max));
  }
  return absl::OkStatus();
}

absl::Status validateSize(SizePx size_px, uint32_t side_px_max) {
  if (size_px.width == 0 || size_px.height == 0) {
    return invalidField(
        "size", strCat("the plane has ", sizeText(size_px), " px; accepted is at least 1x1"));
  }
  if (std::max(size_px.width, size_px.height) > side_px_max) {
    return overLimit("size", strCat("the plane has ", sizeText(size_px), " px; accepted is up to ",
                                    side_px_max, " px a side"));
  }
  return absl::OkStatus();
}

absl::Status validateStride(const PlaneFormat& plane) {
  if (plane.stride_bytes == 0) return absl::OkStatus();
  if (isCodedPicture(plane.encoding)) {
    return invalidField("stride_bytes", strCat("the stride of a JPEG or H.264 is ",
                                               plane.stride_bytes, " bytes; accepted is 0"));
  }
  const uint64_t packed = uint64_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
  if (plane.stride_bytes < packed || plane.stride_bytes > packed + kRowPaddingBytesMax) {
    return invalidField("stride_bytes", strCat("the stride is ", plane.stride_bytes,
                                               " bytes; accepted is 0 (packed) or ", packed, "..",
                                               packed + kRowPaddingBytesMax));
  }
  return absl::OkStatus();
}

// Prediction is between samples of 16 bits that lie side by side. H.264 does not shrink any more.
absl::Status validateCompression(const PlaneFormat& plane) {
  if (plane.encoding == PlaneEncoding::kH264 && plane.compression != PlaneCompression::kNone) {
    return invalidField("compression",
                        "the H.264 is compressed once more; accepted for H264 is NONE");
  }
  if (plane.compression != PlaneCompression::kPredictedZstd) return absl::OkStatus();
  if (plane.encoding != PlaneEncoding::kDepthU16 && plane.encoding != PlaneEncoding::kDepthF16) {
    return invalidField("compression",
                        "PREDICTED_ZSTD is given for another encoding than DEPTH_U16 and "
                        "DEPTH_F16; accepted here is NONE or ZSTD");
  }
  if (plane.stride_bytes == 0) return absl::OkStatus();
  return invalidField("stride_bytes", strCat("the stride is ", plane.stride_bytes,
                                             " bytes; accepted with PREDICTED_ZSTD is 0"));
}

absl::Status validateWireBytes(const PlaneFormat& plane) {
  const uint64_t got = plane.wire_bytes;
  const uint64_t content = uncompressedBytes(plane);
  const bool is_coded = isCodedPicture(plane.encoding);
  if (plane.compression == PlaneCompression::kNone && !is_coded && got != content) {
    return invalidField("bytes_count",
                        strCat("the plane declares ", got, " bytes; accepted is ", content,
                               ", which ", sizeText(plane.size_px), " px take in this encoding"));
  }
  uint64_t most = is_coded ? codedBytesMax(plane) : content;
  if (plane.compression != PlaneCompression::kNone) most = zstdBytesMax(most);
  most = std::min(most, kPlaneWireBytesMax);
  if (got == 0 || got > most) {
    return invalidField("bytes_count",
                        strCat("the plane declares ", got, " bytes; accepted is 1..", most));
  }
  return absl::OkStatus();
}

absl::Status validateVideo(const PlaneFormat& plane) {
  if (plane.encoding != PlaneEncoding::kH264) return absl::OkStatus();
  if (std::min(plane.size_px.width, plane.size_px.height) >= kH264SideMin_px) {
    return absl::OkStatus();
  }
  return invalidField(
      "size", strCat("a plane of H264 has ", sizeText(plane.size_px), " px; accepted is at least ",
                     kH264SideMin_px, "x", kH264SideMin_px, ", smaller ones as RGB8 or JPEG"));
}

}  // namespace

std::string sizeText(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height);
}

absl::Status validatePlane(const PlaneFormat& plane, PlaneKind kind, bool is_cube_map,
                           uint32_t side_px_max) {
  if (plane.kind != kind || !isEncodingOf(kind, plane.encoding)) {
    return invalidField(
        "encoding",
        strCat("the encoding does not fit the kind of the plane; accepted is ", encodingsOf(kind)));
  }
  VIEWLOOM_RETURN_IF_ERROR(is_cube_map ? validateCubeSize(plane.size_px, side_px_max)
                                       : validateSize(plane.size_px, side_px_max));
  VIEWLOOM_RETURN_IF_ERROR(validateVideo(plane));
  VIEWLOOM_RETURN_IF_ERROR(validateStride(plane));
  VIEWLOOM_RETURN_IF_ERROR(validateCompression(plane));
  VIEWLOOM_RETURN_IF_ERROR(validateWireBytes(plane));
  if (kind == PlaneKind::kColor) {
    if (!is_cube_map || plane.alpha == AlphaMode::kOpaque) return absl::OkStatus();
    return fieldError(absl::StatusCode::kUnimplemented, "alpha",
                      "transparent colour of cube maps is not served yet; accepted is OPAQUE");
  }
  if (kind != PlaneKind::kDepth) return absl::OkStatus();
  return validateDepthFormat(plane.depth, plane.encoding, "depth");
}

}  // namespace viewloom
