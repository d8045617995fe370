// SPDX-License-Identifier: Apache-2.0
// How far surfaces that rays through a lens meet may lie off the sheet that stands for them
// (shaders/lens.md).
#ifndef VIEWLOOM_SHADERS_SHARED_SHEET_REACH_H_
#define VIEWLOOM_SHADERS_SHARED_SHEET_REACH_H_

#include "shared/gpu_types.h"
#include "shared/trace_abi.h"

#ifdef __cplusplus
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#endif

VIEWLOOM_ABI_BEGIN

#ifdef __cplusplus
using glm::length;
using glm::max;
using glm::min;
#endif

// Rays through the rim meet a surface in focus no further beside where they meet its sheet, px of
// the source.
VIEWLOOM_ABI_CONST float kSheetReach_px = 0.125f;
// And a blurred one further by this share of its blur's radius.
VIEWLOOM_ABI_CONST float kSheetReachOfBlur = 0.03125f;
// Least of what rays go along the source's axis for a metre along their view's, for Z to tell how
// much they are blurred.
VIEWLOOM_ABI_CONST float kForwardMin = 0.05f;

// Reach of sheets in focus: in_focus, 1/m. Others have more in proportion to their blur, which is
// linear in 1/Z and 0 at the focus: |of_blur_inv_z inv_z - of_blur_focus|.
struct SheetReach {
  float in_focus;
  float of_blur_inv_z;
  float of_blur_focus;
};

// Reach for surfaces that the view meets at px `at` of the source. Its ray through the middle of
// the lens goes direction_z m along the source's axis for a metre along the view's. A ray whose eye
// is m (homogeneous px) meets a surface that is d of 1/Z nearer (m.xy - at m.z) d beside. The ray
// through the rim meets inv_z beside the ray through the middle: by the eye's move for a metre,
// times inv_z (1 + eye.z / (focus direction_z)) - 1 / (focus direction_z).
VIEWLOOM_ABI_INLINE SheetReach sheetReach(ViewParams view, vec2 at, float direction_z) {
  const vec2 along_x = vec2(view.direction_dx) - at * view.direction_dx.z;
  const vec2 along_y = vec2(view.direction_dy) - at * view.direction_dy.z;
  const float rim_px_m =
      max(length(view.lens_px_m.x * along_x), length(view.lens_px_m.y * along_y));
  const float beside_px_m = length(vec2(view.eye) - at * view.eye.z);
  const float moved_px_m = max(beside_px_m + rim_px_m, 1e-30f);
  const bool is_forward = direction_z > kForwardMin;
  const float inv_focus = is_forward ? view.lens_inv_focus / direction_z : 0.0f;
  const float of_blur = is_forward ? kSheetReachOfBlur * rim_px_m / moved_px_m : 0.0f;
  SheetReach reach;
  reach.in_focus = kSheetReach_px / moved_px_m;
  reach.of_blur_inv_z = of_blur * (1.0f + view.eye.z * inv_focus);
  reach.of_blur_focus = of_blur * inv_focus;
  return reach;
}

// 1/m: the least over surfaces of least to largest 1/Z.
VIEWLOOM_ABI_INLINE float leastReach(SheetReach reach, float least_inv_z, float largest_inv_z) {
  const float a = reach.of_blur_inv_z * least_inv_z - reach.of_blur_focus;
  const float b = reach.of_blur_inv_z * largest_inv_z - reach.of_blur_focus;
  return reach.in_focus + max(max(min(a, b), -max(a, b)), 0.0f);
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_SHEET_REACH_H_
