// SPDX-License-Identifier: Apache-2.0
// What rows of surfaces are made of.
#pragma once

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
FiveRows rowsAround(const DepthColumns& columns, int y);

// A row of a colour plane that vectors may be loaded from: they may read beyond its last px, which
// of the last row is the plane's; that row's `copy`, with room for the slack.
const uint32_t* readableColorRow(const RowSource& source, uint32_t layer, int y, uint32_t* copy);

}  // namespace viewloom
