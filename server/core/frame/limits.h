// SPDX-License-Identifier: Apache-2.0
// Limits of frames. Every declared field is checked before a byte is allocated for it.
#pragma once

#include <cstdint>

#include "base/status.h"
#include "frame/frame.h"

namespace viewloom {

struct FrameLimits {
  uint32_t plane_side_px_max = 8192;
  // Bytes of all planes together. Each counts with the larger of its decoded and its wire bytes.
  uint64_t frame_bytes_max = uint64_t{3} << 29;  // 1.5 GiB
  uint32_t layer_count_max = 4;
  uint32_t source_count_max = 8;
};

inline constexpr uint64_t kPlaneWireBytesMax = uint64_t{512} << 20;

// Upper bound for the bytes of a baseline JPEG of so many pixels.
uint64_t jpegBytesMax(uint64_t area_px);
// Upper bound for the bytes of a plane of H264. More could only hide work from the price of a
// frame.
uint64_t h264BytesMax(SizePx size_px);
// Largest picture of H.264 up to level 5.1. A larger plane has several, one below the other.
inline constexpr uint64_t kH264PictureMax_px = 9'437'184;
// Least side of a plane of H264.
inline constexpr uint32_t kH264SideMin_px = 16;
// Bytes from row to row of an uncompressed plane as sent: the declared stride, or packed.
uint64_t wireRowBytes(const PlaneFormat& plane);
// Bytes of the plane before compression, with stride; 0 for coded pictures.
uint64_t uncompressedBytes(const PlaneFormat& plane);
// Bytes a pixel of LayerPlanes::surface, for layers that mirror.
inline constexpr uint32_t kSurfaceTexelBytes = 8;
// Bytes of the plane once it is decoded: packed, RGB8, JPEG and H264 as RGBA8.
uint64_t decodedBytes(const PlaneFormat& plane);

// Checks a whole header. Errors name the field as in proto
// ("header.sources[0].layers[1].planes[0].size"). INVALID_ARGUMENT for impossible values,
// RESOURCE_EXHAUSTED for values over these limits.
absl::Status validateFrame(const FrameFormat& format, const FrameLimits& limits);

}  // namespace viewloom
