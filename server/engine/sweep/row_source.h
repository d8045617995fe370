// SPDX-License-Identifier: Apache-2.0
// Depth and colour that rows of surfaces are made of.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sweep/depth_columns.h"
#include "sweep/facet_kernels.h"
#include "sweep/measure_columns.h"
#include "sweep/sweep_fault.h"

namespace viewloom {

// Colour planes are opaque sRGB, RGBA8, of the depth planes' size.
struct RowSource {
  const DepthColumns* columns = nullptr;
  ByLayer<const uint32_t*> color{};  // uint32[height][width]
  SurfaceSteps steps;
  SweepFault planted_fault = SweepFault::kNone;
};

inline constexpr uint32_t kRowSlack = 64;  // what vectors read and write beyond the width

// The five rows around one, from two above to two below.
inline FiveRows rowsAround(const DepthColumns& columns, int y) {
  FiveRows rows{.inv_z = {}, .layer_count = columns.layerCount(), .width = columns.sizePx().width};
  for (int k = 0; k < 5; ++k) {
    for (uint32_t i = 0; i < rows.layer_count; ++i) {
      rows.inv_z[size_t(k)][i] = columns.row(i, y + k - 2);
    }
  }
  return rows;
}

// A row of a colour plane that vectors may be loaded from: they may read beyond its last px, which
// of the last row is the plane's; that row's `copy`, with room for the slack.
inline const uint32_t* readableColorRow(const RowSource& source, uint32_t layer, int y,
                                        uint32_t* copy) {
  const SizePx size_px = source.columns->sizePx();
  const uint32_t* const row = source.color[layer] + size_t(y) * size_px.width;
  if (uint32_t(y) + 1 < size_px.height && size_px.width >= kRowSlack) return row;
  std::copy_n(row, size_px.width, copy);
  return copy;
}

}  // namespace viewloom
