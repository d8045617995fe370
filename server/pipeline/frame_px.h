// SPDX-License-Identifier: Apache-2.0
// Sizes of frames that the cost of their structures is predicted from.
#pragma once

#include <cstdint>

#include "frame/frame.h"
#include "schedule/resident_structure.h"

namespace viewloom {

// Depth samples of all layers.
inline uint64_t pxOf(const Frame& frame) {
  uint64_t count = 0;
  for (const SourceFormat& source : frame.format.sources) {
    for (const LayerFormat& layer : source.layers) count += layer.depth.size_px.area();
  }
  return count;
}

// Those of one layer of each source.
inline uint64_t pxOf(const ResidentStructure& structure) {
  uint64_t count = 0;
  for (const SeenSource& source : structure.sources) count += source.size_px.area();
  return count;
}

}  // namespace viewloom
