// SPDX-License-Identifier: Apache-2.0
// A thin lens before a view: its rays pass through points of the lens instead of its middle, and
// all those of a px meet in the focus.
#ifndef VIEWLOOM_LIB_LENS_LENS_GLSL_
#define VIEWLOOM_LIB_LENS_LENS_GLSL_

#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

// Points of the lens: those of a sample of each px of the pattern, then those of the next sample.
layout(set = 0, binding = kBindingLensPoints, scalar) readonly buffer LensPoints {
  vec2 lens_points[];
};

// `px`: of the tile.
uint lensPatternIndex(uvec2 px) {
  const uvec2 place = px % kLensPatternSide_px;
  return place.y * kLensPatternSide_px + place.x;
}

// The view from a point of its lens, whose radius is 1, to the right and up. A step of a px is
// 1 / focal length of a metre at a depth of 1 m, and rows run down.
ViewParams viewThrough(ViewParams view, vec2 point) {
  const vec2 moved_px = view.lens_px_m * point;
  const vec3 moved = moved_px.x * view.direction_dx - moved_px.y * view.direction_dy;
  view.eye += moved;
  view.direction -= view.lens_inv_focus * moved;
  return view;
}

#endif  // VIEWLOOM_LIB_LENS_LENS_GLSL_
