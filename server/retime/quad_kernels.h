// SPDX-License-Identifier: Apache-2.0
// Which samples are connected all around, with the vectors of the CPU it runs on.
#pragma once

#include <cstdint>

#include "retime/moved_samples.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Links of two rows, uint8[width] each (sweep/link_kernels.h).
struct LinkedRows {
  ByLayer<const uint8_t*> to_right{};
  ByLayer<const uint8_t*> to_below{};
  ByLayer<const uint8_t*> to_right_below{};  // of the row below
  uint32_t layer_count = 0;
};

// The quads that begin at those columns, of which none is the last.
void findQuads(const LinkedRows& rows, uint32_t first, uint32_t end,
               const ByLayer<QuadLayers*>& quads);

// Keeps the quads that are to be drawn (MovedSamples::quads), of those that begin at `count`
// samples of a row from `sample` on.
void keepDrawnQuads(const MovedSamples& samples, uint32_t sample, uint32_t count,
                    const QuadLayers* quads, QuadLayers* drawn);

// MovedSamples::covered, of those columns of all layers of row `y`.
void coverQuadrants(const MovedSamples& samples, uint32_t y, uint32_t first, uint32_t end,
                    uint8_t* covered);

}  // namespace viewloom
