// SPDX-License-Identifier: Apache-2.0
// Links of a row of facets, and colours blended along links to the next row, with the vectors of
// the CPU it runs on. What they mean: shaders/structure.md. Every array that kernels take may be
// read and written a vector beyond its width.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "shared/structure_abi.h"
#include "sweep/facet_kernels.h"
#include "sweep/measure_columns.h"

namespace viewloom {

// Links between the columns of a row: 0 = silhouette, 1 + k = linked to layer k of the column on
// the right (left), abi::kDeepEdge. uint8[width] each; 1 + its own layer where there is no facet:
// nothing begins or ends there.
void linkColumns(const FacetRow& row, const SurfaceSteps& steps, const ByLayer<uint8_t*>& to_right,
                 const ByLayer<uint8_t*>& to_left);

// Links between two rows, at the middles of their columns' edges; `slope` is that along y. As of
// columns, but for 0 where there is no facet.
void linkRows(const FacetRow& above, const FacetRow& below, const SurfaceSteps& steps,
              const ByLayer<uint8_t*>& to_below, const ByLayer<uint8_t*>& to_above);

// The first of these links from `first` on that is not `value`; `end` if there is none before.
inline uint32_t findOther(const uint8_t* bytes, uint32_t first, uint32_t end, uint8_t value) {
  const uint64_t pattern = 0x0101010101010101U * value;
  for (uint32_t x = first; x < end; x += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes + x, sizeof word);
    word ^= pattern;
    if (word != 0) return std::min(x + uint32_t(std::countr_zero(word)) / 8, end);
  }
  return end;
}

// Whether no surface goes on over such a link.
inline bool isSilhouette(uint8_t link) {
  return link == 0 || link == abi::kDeepEdge;
}

// Colours of a row between the samples of two rows: of each facet, blended with what it is linked
// to in the other row, as packed codes (sweep/packed_codes.h).
struct TexelRow {
  FacetRow here;   // slopes along y
  FacetRow there;  // the next row
  ByLayer<const uint32_t*> color_here;
  ByLayer<const uint32_t*> color_there;
  float share = 0;        // of the other row, 0..0.5
  bool is_below = false;  // the other row
  ByLayer<uint32_t*> texels;
};
void blendRows(const TexelRow& row, const StepRule& kappa);

}  // namespace viewloom
