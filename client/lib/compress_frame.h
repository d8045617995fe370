// SPDX-License-Identifier: Apache-2.0
// Compresses the planes of a frame for the wire, if that makes them smaller.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lib/quantise_depth.h"
#include "lib/wire_frame.h"

namespace viewloom {

// Replaces 16-bit depth by differences from the plane through its neighbours. Differences on
// surfaces are near 0 and compress well. Lossless.
//
// samples: uint16_t[height_px][width_px], little endian. Returns uint8_t[2][height_px][width_px],
// the content of a zstd frame as proto PLANE_COMPRESSION_PREDICTED_ZSTD says.
std::vector<uint8_t> predictPlane(std::span<const uint8_t> samples, uint32_t width_px,
                                  uint32_t height_px);

struct CompressionOptions {
  // Level of zstd for every plane, 1 (fast) to 19. 0: only predicted depth uses zstd.
  int zstd_level = 0;
  // Binary32 depth becomes 16-bit inverse depth, if that is fine enough (lib/quantise_depth.h).
  // 16-bit depth is sent as differences from its neighbours, without loss. Depth that stays
  // binary32 is compressed with zstd.
  bool predicts_depth = false;
};

struct CompressedFrame {
  WireFrame frame;
  std::vector<QuantisedDepth> depth;  // one for each source; empty if depth is not predicted
};

// Compresses a frame. JPEG and H.264 planes, compressed planes and planes that would grow are not
// changed.
CompressedFrame compressFrame(WireFrame frame, const CompressionOptions& options);

}  // namespace viewloom
