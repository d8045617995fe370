// SPDX-License-Identifier: Apache-2.0
// One pass of smoothing over a row of coarse columns, with the vectors of the CPU it runs on: what
// smooth_columns.comp does (shaders/structure.md, Coarse depth).
#pragma once

#include <cstdint>

#include "sweep/surface_row.h"

namespace viewloom {

// Rows begin at column 0; there is no surface for two strides and two vectors around the image.
struct SmoothedRow {
  uint32_t layer_count = 0;
  uint32_t width = 0;
  int stride = 1;
  float reach = 0;                // 1/m
  ByLayer<const float*> samples;  // as they came
  ByLayer<const float*> here;     // as the pass before has left them, as are
  ByLayer<const float*> above;    // those of the row `stride` px above,
  ByLayer<const float*> below;    // and of the one below
  ByLayer<float*> result;         // may be the samples
};

// May write up to a vector beyond the width.
void smoothRow(const SmoothedRow& row);

}  // namespace viewloom
