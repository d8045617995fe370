// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_layout.h"

namespace viewloom {

StructureLayout structureLayout(SizePx depth_px) {
  StructureLayout layout;
  layout.size_px = depth_px;
  uint32_t offset = 0;
  for (uint32_t i = 0; i < abi::kLevelCount; ++i) {
    const uint32_t node_px = 1u << (abi::kLevelFirst + i);
    const SizePx size{(depth_px.width + node_px - 1) / node_px,
                      (depth_px.height + node_px - 1) / node_px};
    layout.levels[i] = {offset, size};
    offset += uint32_t(size.area());
  }
  return layout;
}

uint64_t colorBytes(ColorStorage storage, SizePx color_px) {
  return color_px.area() * (storage == ColorStorage::kRgba8Srgb ? 4 : 8);
}

}  // namespace viewloom
