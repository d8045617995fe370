// SPDX-License-Identifier: Apache-2.0
// Depth planes of 16 bits as differences from the plane through their neighbours: what is left of
// surfaces is near 0, and packs well.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace viewloom {

// samples: uint16_t[height_px][width_px], little endian. Returns uint8_t[2][height_px][width_px],
// the content of a zstd frame as proto PLANE_COMPRESSION_PREDICTED_ZSTD says. Loses nothing.
std::vector<uint8_t> predictPlane(std::span<const uint8_t> samples, uint32_t width_px,
                                  uint32_t height_px);

}  // namespace viewloom
