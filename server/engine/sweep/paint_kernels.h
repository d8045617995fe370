// SPDX-License-Identifier: Apache-2.0
// Sweeps a row of a view over the surfaces of a row of the source (shaders/sweep.md),
// with the vectors of the CPU it runs on.
#pragma once

#include <cstdint>

#include "frame/stage_times.h"
#include "sweep/sweep_fault.h"
#include "sweep/swept_row.h"

namespace viewloom {

// Colour of rays that meet nothing.
struct SweepFill {
  bool fills_border = true;  // the image's border goes on where it was left
  uint32_t background = 0;   // R, G, B, 255 in memory order
  float inv_z_max = 0;       // of the source, 1/m
  SweepFault planted_fault = SweepFault::kNone;
};

// Finds what each px of the row sees, and adds to `coverage`.
void paintRow(const SurfaceRow& row, const SweepView& view, const SweepFill& fill,
              uint32_t width_px, SweptRow& swept, Coverage& coverage);

}  // namespace viewloom
