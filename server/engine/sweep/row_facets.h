// SPDX-License-Identifier: Apache-2.0
// Facets of a row of a source, layer by layer, with the memory that they need on their way.
#pragma once

#include <cstdint>

#include "sweep/row_source.h"
#include "sweep/surface_row.h"

namespace viewloom {

// All by column. Links are those of link_kernels.h.
struct LayerFacets {
  AlignedArray<float> slope_x, slope_y, slope_y_there;
  AlignedArray<float> left, right;  // 1/Z at the edges; at the end of a run, that of the run
  AlignedArray<uint8_t> to_right, to_left;
  AlignedArray<uint32_t> texels;
  AlignedArray<int32_t> texel;  // 256 times its index among those of the row
  AlignedArray<uint32_t> color_here, color_there;

  void reserve(uint32_t size) {
    for (auto* values : {&slope_x, &slope_y, &slope_y_there, &left, &right}) values->reserve(size);
    for (auto* values : {&to_right, &to_left}) values->reserve(size);
    for (auto* values : {&texels, &color_here, &color_there}) values->reserve(size);
    texel.reserve(size);
  }
};

// Thread-safety: none; one a thread.
struct RowFacets {
  uint32_t width = 0;
  uint32_t layer_count = 0;
  ByLayer<const float*> inv_z{};
  ByLayer<LayerFacets> layers;
  SurfaceSteps steps;
  SweepFault planted_fault = SweepFault::kNone;

  bool hasFault(SweepFault fault) const { return planted_fault == fault; }
};

}  // namespace viewloom
