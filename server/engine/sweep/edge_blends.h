// SPDX-License-Identifier: Apache-2.0
// Px that silhouettes cover in part (shaders/color.md, Edges), with the vectors of the CPU it runs
// on.
#pragma once

#include "sweep/swept_row.h"

namespace viewloom {

// Finds them in a row that is painted: fills swept.blends.
void findEdgeBlends(const SurfaceRow& row, const SweepView& view, uint32_t width_px,
                    SweptRow& swept);

// Blends colours, R, G, B, 255 in memory order, of width_px px. Thread-safety: none.
void applyEdgeBlends(EdgeBlends& blends, uint32_t* rgba);

}  // namespace viewloom
