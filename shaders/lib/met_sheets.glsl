// SPDX-License-Identifier: Apache-2.0
// How far surfaces that a ray through a lens met may lie off the sheet that stands for them.
#ifndef VIEWLOOM_LIB_MET_SHEETS_GLSL_
#define VIEWLOOM_LIB_MET_SHEETS_GLSL_

#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

// 1/m: what moves a ray through the rim of the lens that meets the surface at px `at` of the source
// by kSheetReach_px there. A ray whose eye is m (homogeneous px) meets what is d of 1/Z nearer
// (m.xy - at m.z) d beside.
float sheetReach(ViewParams view, vec2 at) {
  const vec2 along_x = view.direction_dx.xy - at * view.direction_dx.z;
  const vec2 along_y = view.direction_dy.xy - at * view.direction_dy.z;
  const float x_px_m = length(view.lens_px_m.x * along_x);
  const float y_px_m = length(view.lens_px_m.y * along_y);
  const float beside_px_m = length(view.eye.xy - at * view.eye.z);
  return kSheetReach_px / max(beside_px_m + max(x_px_m, y_px_m), 1e-30);
}

#endif  // VIEWLOOM_LIB_MET_SHEETS_GLSL_
