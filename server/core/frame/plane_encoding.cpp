// SPDX-License-Identifier: Apache-2.0
#include "frame/plane_encoding.h"

#include <algorithm>

#include "frame/limits.h"

namespace viewloom {

bool isEncodingOf(PlaneKind kind, PlaneEncoding encoding) {
  switch (encoding) {
    case PlaneEncoding::kRgba8:
    case PlaneEncoding::kRgb8:
      return kind == PlaneKind::kColor || kind == PlaneKind::kSpecular;
    case PlaneEncoding::kRgba16f:
    case PlaneEncoding::kJpeg:
    case PlaneEncoding::kH264:
      return kind == PlaneKind::kColor;
    case PlaneEncoding::kDepthF32:
    case PlaneEncoding::kDepthF16:
    case PlaneEncoding::kDepthU16:
      return kind == PlaneKind::kDepth;
    case PlaneEncoding::kXyz16f:
      return kind == PlaneKind::kNormal || kind == PlaneKind::kMotion;
    case PlaneEncoding::kXyz8:
    case PlaneEncoding::kOct16:
      return kind == PlaneKind::kNormal;
    case PlaneEncoding::kR8:
      return kind == PlaneKind::kRoughness || kind == PlaneKind::kSpecular;
  }
  return false;
}

const char* encodingsOf(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kColor:
      return "RGBA8, RGB8, RGBA16F, JPEG, H264";
    case PlaneKind::kDepth:
      return "DEPTH_F32, DEPTH_F16, DEPTH_U16";
    case PlaneKind::kMotion:
      return "XYZ16F";
    case PlaneKind::kNormal:
      return "OCT16, XYZ16F, XYZ8";
    case PlaneKind::kRoughness:
      return "R8";
    case PlaneKind::kSpecular:
      return "RGB8, RGBA8, R8";
  }
  return "";
}

bool isCodedPicture(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::kJpeg || encoding == PlaneEncoding::kH264;
}

uint64_t codedBytesMax(const PlaneFormat& plane) {
  return plane.encoding == PlaneEncoding::kH264 ? h264BytesMax(plane.size_px)
                                                : jpegBytesMax(plane.size_px.area());
}

bool becomesRgba8(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::kRgb8 || isCodedPicture(encoding);
}

uint64_t codecBytes(const PlaneFormat& plane) {
  if (plane.encoding != PlaneEncoding::kH264) return 0;
  // Measured: tests/performance.md, "Colour as video". Six pictures have 1.5 bytes a pixel each,
  // also of their rims: 32 px all around, and up to 46 px until widths can be divided by 16 and 32.
  // Narrow pictures have more rim than picture.
  constexpr uint64_t kDecoderBytes = uint64_t{4} << 20;
  constexpr uint64_t kPictureBytes = 9;
  constexpr uint64_t kBlockBytes = 11;  // vectors, modes and coefficients of blocks
  constexpr uint64_t kBlock_px = 16;
  constexpr uint64_t kChromaBytes = 2;  // at the size of luma, on its way to RGB
  constexpr uint64_t kRim_px = 2 * 32 + 46;
  const uint64_t width_px = std::max(plane.size_px.width, 1U);
  const uint64_t height_px =
      std::min<uint64_t>(plane.size_px.height, kH264PictureMax_px / width_px + 1);
  return kDecoderBytes + kPictureBytes * (width_px + kRim_px) * (height_px + kRim_px) +
         kBlockBytes * (width_px + kBlock_px) * (height_px + kBlock_px) +
         kChromaBytes * (width_px + 1) * height_px + 2 * plane.wire_bytes;
}

uint32_t wirePixelBytes(PlaneEncoding encoding) {
  switch (encoding) {
    case PlaneEncoding::kRgba8:
    case PlaneEncoding::kDepthF32:
    case PlaneEncoding::kOct16:
      return 4;
    case PlaneEncoding::kXyz16f:
      return 6;
    case PlaneEncoding::kRgb8:
    case PlaneEncoding::kXyz8:
      return 3;
    case PlaneEncoding::kRgba16f:
      return 8;
    case PlaneEncoding::kDepthF16:
    case PlaneEncoding::kDepthU16:
      return 2;
    case PlaneEncoding::kR8:
      return 1;
    case PlaneEncoding::kJpeg:
    case PlaneEncoding::kH264:
      return 0;
  }
  return 0;
}

uint64_t inflatedBytesMax(const PlaneFormat& plane) {
  if (plane.compression == PlaneCompression::kNone) return 0;
  if (plane.encoding != PlaneEncoding::kJpeg) return uncompressedBytes(plane);
  // A JPEG that is larger than its pixels is no picture, but for its headers.
  const uint64_t header_bytes = jpegBytesMax(0);
  return std::min(jpegBytesMax(plane.size_px.area()), decodedBytes(plane) + header_bytes);
}

bool isHeldAsSent(const PlaneFormat& plane) {
  return !becomesRgba8(plane.encoding) && plane.compression != PlaneCompression::kPredictedZstd &&
         uncompressedBytes(plane) == decodedBytes(plane);
}

bool widensOnArrival(const PlaneFormat& plane) {
  return plane.encoding == PlaneEncoding::kRgb8 && plane.compression == PlaneCompression::kNone &&
         wireRowBytes(plane) == uint64_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
}

}  // namespace viewloom
