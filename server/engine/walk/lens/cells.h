// SPDX-License-Identifier: Apache-2.0
// Cells of a structure as the CPU reads them: node.glsl and facet.glsl of shaders/lib/structure.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "lens/beam.h"
#include "lens/host_structure.h"

namespace viewloom {

// A place in the pyramid of a layer.
struct CellAt {
  uint32_t level;
  glm::uvec2 cell;

  RectPx rect() const {
    const glm::vec2 low(cell << level);
    return {low, low + float(1U << level)};
  }
  glm::vec2 center() const { return glm::vec2(cell << level) + 0.5F * float(1U << level); }
};

// A node or a facet: a plane, or a box of what is below it.
struct SurfaceCell {
  bool is_plane = false;  // a facet without a surface is none
  float inv_z = 0;        // plane: in the middle, 1/m
  glm::vec2 slope{0};     // plane: for a px
  float error = 0;        // plane: no facet of it is further away anywhere
  glm::vec2 range{-1};    // of everything in it: least and largest; < 0: nothing is

  // Plane, px beside the middle.
  float at(glm::vec2 offset) const { return inv_z + glm::dot(slope, offset); }
};

inline glm::vec2 unpackSlopes(uint32_t bits) {
  return {std::bit_cast<float>(bits << 16), std::bit_cast<float>(bits & 0xffff0000U)};
}

inline SurfaceCell planeCell(float inv_z, glm::vec2 slope, float error, uint32_t level) {
  const float half_px = 0.5F * float(1U << level);
  const float half_range = half_px * (std::abs(slope.x) + std::abs(slope.y)) + error;
  return {.is_plane = true,
          .inv_z = inv_z,
          .slope = slope,
          .error = error,
          .range = {std::max(inv_z - half_range, 0.0F), inv_z + half_range}};
}

inline SurfaceCell facetCell(abi::uvec2 bits) {
  if (bits.x == abi::kNoFacet) return {};
  return planeCell(std::bit_cast<float>(bits.x & ~abi::kForwardLinkFlag), unpackSlopes(bits.y), 0,
                   abi::kLevelFacets);
}

inline SurfaceCell nodeCell(abi::uvec2 bits, uint32_t level) {
  if ((bits.x & 0x80000000U) == 0) {
    return {.range = {std::bit_cast<float>(bits.x & 0x7ffffff8U), std::bit_cast<float>(bits.y)}};
  }
  constexpr uint32_t kErrorFirst = 99U << 1;
  return planeCell(std::bit_cast<float>(bits.x & 0x7ffffe00U), unpackSlopes(bits.y),
                   std::bit_cast<float>(((bits.x >> 3 & 63U) + kErrorFirst) << 22), level);
}

inline SurfaceCell surfaceCell(const HostStructure& structure, uint32_t layer, uint32_t level,
                               glm::uvec2 at) {
  const uint32_t width = structure.padded_width >> level;
  const abi::uvec2 bits = structure.level(layer, level)[at.y * width + at.x];
  return level == abi::kLevelFacets ? facetCell(bits) : nodeCell(bits, level);
}

}  // namespace viewloom
