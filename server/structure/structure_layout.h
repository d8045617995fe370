// SPDX-License-Identifier: Apache-2.0
// How large the arrays of one layer of a structure are, and where each level of the pyramid begins.
#pragma once

#include <array>
#include <cstdint>

#include "frame/size.h"
#include "shared/structure_abi.h"
#include "structure/frame_shape.h"

namespace viewloom {

struct LevelLayout {
  uint32_t offset = 0;  // nodes before this level
  SizePx size;          // nodes
};

struct StructureLayout {
  SizePx size_px;
  std::array<LevelLayout, abi::kLevelCount> levels;  // of level abi::kLevelFirst + index

  uint64_t invZBytes() const { return size_px.area() * 4; }
  uint64_t facetBytes() const { return size_px.area() * 8; }
  uint64_t linkBytes() const { return size_px.area() * 2; }
  uint64_t entryBytes() const { return levels[0].size.area() * 8; }
  uint64_t nodeCount() const { return levels.back().offset + levels.back().size.area(); }
  uint64_t nodeBytes() const { return nodeCount() * 8; }
  uint64_t layerBytes() const {
    return invZBytes() + facetBytes() + linkBytes() + entryBytes() + nodeBytes();
  }
};

StructureLayout structureLayout(SizePx depth_px);
uint64_t colorBytes(ColorStorage storage, SizePx color_px);

}  // namespace viewloom
