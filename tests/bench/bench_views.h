// SPDX-License-Identifier: Apache-2.0
// The views of the benchmark's loads. How wide they look is stated by the span: how far, px of the
// source, the outermost view sees the nearest surface from the sky behind it.
#pragma once

#include <cstdint>
#include <string_view>

#include "display/atlas_layout.h"

namespace viewloom::bench {

struct SourceView {
  Camera camera;
  SizePx size_px;
  SourceStats stats;
  uint32_t miniature = 1;  // tiles are so many times smaller on a side
};

// Off-axis views in a row, in the grid and the size of a preset.
AtlasLayout quiltOfSpan(const SourceView& source, std::string_view preset, double span_px);
// side x side off-axis views of a square of eyes, 420x420 px each.
AtlasLayout gridOfSpan(const SourceView& source, uint32_t side, double span_px);
// One view of the source's size that stands aside, a step ahead, turned and rolled.
AtlasLayout rotatedView(const SourceView& source, double span_px);
// 8 x 2 views of a camera that steps from one side to the other and ahead, and turns on its way;
// each a third of the source's size on a side.
AtlasLayout steppingCamera(const SourceView& source, double span_px);
// Off-axis views in a row that share a fixed number of px, so that only their number differs.
AtlasLayout viewsOfSharedArea(const SourceView& source, uint32_t view_count, double span_px);

}  // namespace viewloom::bench
