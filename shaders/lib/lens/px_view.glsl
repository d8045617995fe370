// SPDX-License-Identifier: Apache-2.0
// The view from where the ray of a px passes its display.
#ifndef VIEWLOOM_LIB_LENS_PX_VIEW_GLSL_
#define VIEWLOOM_LIB_LENS_PX_VIEW_GLSL_

#include "lib/lens/lens.glsl"
#include "lib/rays/extras.glsl"
#include "lib/rays/ray_source.glsl"

// `px`: of the tile. `rays`, kRaysOf..., and `through_lens` are constants of the kernel.
ViewParams viewOfPx(ViewParams view, Aim aim, uvec2 px, uint rays, bool through_lens) {
  if (rays != kRaysOfPinholes) view = viewFrom(view, extras.eye_axes, aim.eye_m);
  if (through_lens) view = viewThrough(view, lens_points[lensPatternIndex(px)]);
  return view;
}

#endif  // VIEWLOOM_LIB_LENS_PX_VIEW_GLSL_
