// SPDX-License-Identifier: Apache-2.0
// Samples of a source once they have moved, and the connected surfaces between them.
#pragma once

#include <array>
#include <cstdint>

#include "frame/size.h"

namespace viewloom {

// The connected surface between a sample, the next in its row and the two below them, as a byte:
// the layers of those three. 0: it is not connected all around.
using QuadLayers = uint8_t;

constexpr QuadLayers quadOf(uint32_t top_right, uint32_t bottom_right, uint32_t bottom_left) {
  return QuadLayers(0x40U | top_right | bottom_right << 2 | bottom_left << 4);
}
// All four on one layer.
constexpr QuadLayers flatQuad(uint32_t layer) {
  return quadOf(layer, layer, layer);
}

// Sides of a sample's footprint, as bits.
enum Quadrant : uint8_t {
  kTopLeft = 1,
  kTopRight = 2,
  kBottomRight = 4,
  kBottomLeft = 8,
};
inline constexpr uint8_t kAllQuadrants = 15;

// Samples are numbered through: (layer * height + row) * width + column. All arrays are [sample],
// and may be read a vector beyond the last and a byte before the first.
struct MovedSamples {
  SizePx size_px;
  uint32_t layer_count = 0;
  const float* dx_px = nullptr;  // from where the frame has it
  const float* dy_px = nullptr;
  // 1/m, after the move; abi::kNoSurface also for what has come behind the camera.
  const float* inv_z = nullptr;
  const uint8_t* moves = nullptr;  // 1, or 0
  // Drawn quads: their four samples exist, were not torn apart, and do not all stand.
  const QuadLayers* quads = nullptr;
  // Quadrants of the footprint that lie in such quads; of samples that stand, all.
  const uint8_t* covered = nullptr;

  uint32_t areaPx() const { return uint32_t(size_px.area()); }
  uint32_t sampleAt(uint32_t layer, uint32_t x, uint32_t y) const {
    return layer * areaPx() + y * size_px.width + x;
  }
  // Samples of a quad that begins at the pixel, in the order of Quadrant.
  std::array<uint32_t, 4> cornersOf(QuadLayers quad, uint32_t layer, uint32_t px) const {
    const uint32_t area = areaPx(), below = px + size_px.width;
    return {layer * area + px, (quad & 3U) * area + px + 1, (quad >> 2 & 3U) * area + below + 1,
            (quad >> 4 & 3U) * area + below};
  }
};

}  // namespace viewloom
