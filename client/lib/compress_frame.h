// SPDX-License-Identifier: Apache-2.0
// Packs the planes of a frame for the wire, where that makes them smaller.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lib/quantise_depth.h"
#include "lib/wire_frame.h"

namespace viewloom {

// Depth of 16 bits as differences from the plane through its neighbours: what is left of surfaces
// is near 0, and packs well. samples: uint16_t[height_px][width_px], little endian. Returns
// uint8_t[2][height_px][width_px], the content of a zstd frame as proto
// PLANE_COMPRESSION_PREDICTED_ZSTD says. Loses nothing.
std::vector<uint8_t> predictPlane(std::span<const uint8_t> samples, uint32_t width_px,
                                  uint32_t height_px);

struct CompressionOptions {
  // 1 (fast) .. 19: every plane with zstd; 0 = none, but for what predicted depth needs.
  int zstd_level = 0;
  // Binary32 depth becomes 16-bit inverse depth, where that is fine enough (lib/quantise_depth.h);
  // depth of 16 bits goes as differences from its neighbours, without loss; what stays binary32 is
  // packed with zstd.
  bool predicts_depth = false;
};

struct CompressedFrame {
  WireFrame frame;
  std::vector<QuantisedDepth> depth;  // of each source; empty when depth is not predicted
};

// JPEG planes, planes already compressed and planes that would grow stay as they are.
CompressedFrame compressFrame(WireFrame frame, const CompressionOptions& options);

}  // namespace viewloom
