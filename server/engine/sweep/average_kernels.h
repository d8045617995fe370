// SPDX-License-Identifier: Apache-2.0
// Means of texels along an axis, with the vectors of the CPU it runs on. What they mean:
// shaders/color.md, Means.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sweep/surface_row.h"

namespace viewloom {

// The px so far above or below each px of a row. Arrays may be read a vector beyond the width; what
// no link leads to may be anything.
struct AverageTap {
  ByLayer<const uint32_t*> color{};  // codes of 8 bits
  // In the px one nearer, to this one: 1 + layer here; what else there is, is no link.
  ByLayer<const uint8_t*> links{};
  ByLayer<const uint8_t*> is_mixed{};  // not 0: it takes no part, but is passed
  // Its weight in the mean of the row's samples, and in that of the next row's.
  float weight_here = 0;
  float weight_there = 0;
};

// A row between two rows of samples: the mean of what is linked around each sample, blended with
// that around what it is linked to in the other row.
struct AverageRow {
  uint32_t layer_count = 0;
  uint32_t width = 0;
  ByLayer<const float*> inv_z{};  // negative where there is no facet: of these, means are anything
  ByLayer<const uint32_t*> color{};  // codes of 8 bits
  ByLayer<const uint8_t*> is_mixed{};
  float weight_there = 0;  // of the row's own samples in the mean of the other row's
  float share = 0;         // of the other row's mean, 0..0.5
  // Away from the other row and towards it, the nearest first. Towards it one more.
  std::array<std::span<const AverageTap>, 2> taps{};
  ByLayer<uint32_t*> means{};  // packed codes (sweep/packed_codes.h)
};
void averageRow(const AverageRow& row);

// Which texels may hold colour of something else: the facet is the far side of a deep silhouette.
// `links`: of its four edges.
void markMixed(const std::array<const uint8_t*, 4>& links, uint32_t width, uint8_t* is_mixed);

// Texels of one surface, side by side, as packed codes.
struct AverageChain {
  const uint32_t* texels = nullptr;  // may be read `tap_count` before and behind, and a vector more
  uint32_t count = 0;
  // The first and the last take no part in the means of others.
  bool is_first_mixed = false;
  bool is_last_mixed = false;
  float reach_px = 0;  // > 0
};
// `means` may be written a vector beyond the last.
void averageChain(const AverageChain& chain, uint32_t* means);

}  // namespace viewloom
