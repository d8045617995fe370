// SPDX-License-Identifier: Apache-2.0
// Depth planes of 16 bits that came as differences from the plane through their neighbours (proto
// PLANE_COMPRESSION_PREDICTED_ZSTD, where the transform is written down).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame/size.h"

namespace viewloom {

// `bytes` are what the plane's zstd frame held, 2 for each px: uint8_t[2][h][w], low bytes first.
// `out` becomes the samples, uint16_t[h][w], little endian. Any bytes are samples: cannot fail.
void restorePredicted(std::span<const uint8_t> bytes, SizePx size_px, std::vector<uint8_t>& out);

}  // namespace viewloom
