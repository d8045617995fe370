// SPDX-License-Identifier: Apache-2.0
#include "offline/effective_nodes.h"

#include <algorithm>

#include "base/check.h"

namespace viewloom {
namespace {

// In the first word of a node (shaders/lib/structure/node.glsl).
constexpr uint32_t kPlaneFlag = 0x80000000u;

struct LayerCells {
  std::span<const abi::uvec2> cells;
  const StructureLayout& layout;

  // With everything below the node that counts.
  uint64_t countFrom(uint32_t level, uint32_t column, uint32_t row) const {
    const SizePx size_px = layout.size_px;
    const uint32_t left_px = column << level;
    const uint32_t top_px = row << level;
    if (left_px >= size_px.width || top_px >= size_px.height) return 0;
    const uint64_t index =
        layout.levelOffset(level) + uint64_t{row} * layout.levelSize(level).width + column;
    if ((cells[index].x & kPlaneFlag) != 0) return 1;
    if (level == abi::kLevelFirst) {
      const uint32_t side_px = 1u << level;
      const uint32_t width_px = std::min(side_px, size_px.width - left_px);
      return 1 + uint64_t{width_px} * std::min(side_px, size_px.height - top_px);
    }
    uint64_t count = 1;
    for (uint32_t child = 0; child < 4; ++child) {
      count += countFrom(level - 1, 2 * column + (child & 1), 2 * row + (child >> 1));
    }
    return count;
  }
};

}  // namespace

uint64_t effectiveNodeCount(std::span<const abi::uvec2> cells, const StructureLayout& layout) {
  VIEWLOOM_CHECK(cells.size() >= layout.cellCount());
  const LayerCells layer{cells, layout};
  const SizePx roots = layout.levelSize(abi::kLevelLast);
  uint64_t count = 0;
  for (uint32_t row = 0; row < roots.height; ++row) {
    for (uint32_t column = 0; column < roots.width; ++column) {
      count += layer.countFrom(abi::kLevelLast, column, row);
    }
  }
  return count;
}

}  // namespace viewloom
