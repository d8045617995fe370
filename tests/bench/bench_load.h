// SPDX-License-Identifier: Apache-2.0
// Input of all contestants of the benchmark: one frame, and the views that are asked of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/surface_steps.h"
#include "picture/trace_job.h"

namespace viewloom::bench {

// The frame as plain arrays, [layer][row][column]. Layers lie nearest first.
struct LoadSource {
  SizePx size_px;
  std::vector<std::vector<float>> inv_z;    // 1/m; kNoSurface where there is none; 0 is the sky
  std::vector<std::vector<uint32_t>> rgba;  // sRGB, red in the low byte
  StepRule kappa;       // largest step within a surface, as viewloom's build settled it
  float inv_z_max = 0;  // of all layers
};

inline constexpr float kNoSurface = -1;  // as shaders/shared/structure_abi.h

// The picture that a camera truly sees of the scene: rgba[row][column] as LoadSource's; alpha is 0
// where the source's image ends before it reaches what is seen.
using TrueView = std::function<std::vector<uint32_t>(const Camera& view, SizePx view_px)>;

struct BenchLoad {
  std::string name;
  FramePtr frame;     // as viewloom takes it
  LoadSource source;  // the same
  // The views, row-major from the top left of the atlas; every tile is used. A ray through tile px
  // (x, y) (centres at + 0.5) is that of abi::ViewParams.
  TraceJob job;
  double disparity_span_px = 0;  // of the outermost view
  // All eyes lie beside the source's, with its axes: no ray leaves its row of the source.
  bool is_one_axis = false;
  TrueView true_view;  // empty: nobody knows
};

}  // namespace viewloom::bench
