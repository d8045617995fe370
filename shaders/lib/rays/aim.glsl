// SPDX-License-Identifier: Apache-2.0
// Which ray a px of a display takes, where displays have more than one eye a view.
#ifndef VIEWLOOM_LIB_RAYS_AIM_GLSL_
#define VIEWLOOM_LIB_RAYS_AIM_GLSL_

#include "shared/trace_abi.h"

struct Aim {
  vec2 tile_px;  // of the view
  vec2 eye_m;    // beside the view's eye, to its right and up
  bool is_used;  // else nobody sees the px: it is black
};

// The view from an eye beside its own.
ViewParams viewFrom(ViewParams view, EyeAxes axes, vec2 eye_m) {
  const vec3 moved = eye_m.x * axes.right + eye_m.y * axes.up;
  view.eye += moved;
  view.direction -= axes.inv_focus * moved;
  return view;
}

#endif  // VIEWLOOM_LIB_RAYS_AIM_GLSL_
