// SPDX-License-Identifier: Apache-2.0
// The rays of a panel behind microlenses. A px is seen through the middle of its lens alone, so its
// ray is the line through both; from the px beside the middle by d, a focal length g behind it, it
// leans by d / g. Followed back to the plane of the display's eye, at a distance D from the lenses,
// it passes d / g D beside the lens.
#ifndef VIEWLOOM_LIB_RAYS_MICROLENS_RAYS_GLSL_
#define VIEWLOOM_LIB_RAYS_MICROLENS_RAYS_GLSL_

#include "lib/rays/aim.glsl"
#include "shared/trace_abi.h"

// `px`: of the panel. Px of the view are those beside the middle of a lens.
Aim aimThroughMicrolens(Microlenses lenses, vec2 px) {
  const vec2 index = floor((px - lenses.first_px) / lenses.pitch_px);
  const vec2 center_px = lenses.first_px + (index + 0.5) * lenses.pitch_px;
  const vec2 beside_px = px - center_px;
  const vec2 eye_m = (center_px - lenses.middle_px) * lenses.m_per_px -
                     beside_px * (lenses.slope_per_px * lenses.distance_m);
  Aim aim;
  aim.tile_px = lenses.slope_per_px < 0.0 ? -beside_px : beside_px;
  aim.eye_m = vec2(eye_m.x, -eye_m.y);
  aim.is_used = all(greaterThanEqual(index, vec2(0.0))) && all(lessThan(index, vec2(lenses.count)));
  return aim;
}

#endif  // VIEWLOOM_LIB_RAYS_MICROLENS_RAYS_GLSL_
