// SPDX-License-Identifier: Apache-2.0
// How far surfaces that a ray through a lens met may lie off the sheet that stands for them.
#ifndef VIEWLOOM_LIB_MET_SHEETS_GLSL_
#define VIEWLOOM_LIB_MET_SHEETS_GLSL_

#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

// 1/m: what moves a ray through the rim of the lens by kSheetReach_px in the source. A point of the
// lens that is m beside its middle (homogeneous px) sees inv_z moved by m inv_z.
float sheetReach(ViewParams view) {
  const float x_px_m = length(view.lens_px_m.x * view.direction_dx.xy);
  const float y_px_m = length(view.lens_px_m.y * view.direction_dy.xy);
  return kSheetReach_px / max(max(x_px_m, y_px_m), 1e-30);
}

#endif  // VIEWLOOM_LIB_MET_SHEETS_GLSL_
