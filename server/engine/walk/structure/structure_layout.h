// SPDX-License-Identifier: Apache-2.0
// How large the arrays of one layer of a structure are (shaders/shared/structure_abi.h).
#pragma once

#include <cstdint>

#include "frame/size.h"
#include "shared/structure_abi.h"
#include "shared/surface_abi.h"
#include "structure/frame_shape.h"

namespace viewloom {

struct StructureLayout {
  SizePx size_px;
  SizePx padded_px;  // rounded up to whole nodes of the last level

  // Cells of a level: facets, entries, or nodes.
  SizePx levelSize(uint32_t level) const {
    const uint32_t shift = level == abi::kLevelEntries ? abi::kLevelFirst : level;
    return {padded_px.width >> shift, padded_px.height >> shift};
  }
  // Cells before a level.
  uint64_t levelOffset(uint32_t level) const {
    return abi::levelOffset(level, uint32_t(padded_px.area()));
  }
  uint64_t cellCount() const { return abi::cellCount(uint32_t(padded_px.area())); }
  uint64_t invZBytes() const {
    return uint64_t{abi::invZArea(size_px.width, size_px.height)} * sizeof(float);
  }
  // Cells of 8 bytes, then links of 2.
  uint64_t layerBytes() const { return cellCount() * 8 + padded_px.area() * 2; }
};

inline StructureLayout structureLayout(SizePx depth_px) {
  const uint32_t mask = (1u << abi::kLevelLast) - 1;
  return {depth_px, {(depth_px.width + mask) & ~mask, (depth_px.height + mask) & ~mask}};
}

// abi::kColor...
inline uint32_t colorFormat(ColorStorage storage) {
  switch (storage) {
    case ColorStorage::kRgba8Srgb:
      return abi::kColorRgba8;
    case ColorStorage::kRgb16Root:
      return abi::kColorRgb16;
    default:
      return abi::kColorRgba16f;
  }
}

inline uint32_t texelBytes(ColorStorage storage) {
  return storage == ColorStorage::kRgba8Srgb ? 4 : 8;
}

inline uint64_t surfaceBytes(SizePx depth_px) {
  return depth_px.area() * sizeof(abi::SurfaceTexel);
}

inline uint64_t colorBytes(ColorStorage storage, SizePx color_px) {
  return color_px.area() * texelBytes(storage);
}

}  // namespace viewloom
