// SPDX-License-Identifier: Apache-2.0
// Where the rays of px come from: the eye of the view, or eyes beside it, on panels with lenses.
#ifndef VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_
#define VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_

#include "lib/rays/extras.glsl"
#include "shared/trace_abi.h"

// Ray that a px takes, where displays have more than one eye a view.
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

// Lambert's continued fraction, within 1e-7 of itself up to 1.3 rad: devices promise 2^-11.
float tangent(float angle_rad) {
  const float square = angle_rad * angle_rad;
  float part = 9.0 - square / 11.0;
  part = 7.0 - square / part;
  part = 5.0 - square / part;
  part = 3.0 - square / part;
  return angle_rad / (1.0 - square / part);
}

// The rays of a lenticular panel. Where a subpixel lies under its lens says which of the views it
// shows (shared/lenticular.h); the views' eyes lie on a line, at equal angles within the cone:
//   x = D tan(cone (z - 1/2)), z the place among the views, D the distance to the panel,
// which is where a quilt's eyes stand. A subpixel's ray leads from there through its own px.
// `px`: of the panel, from its top left.
Aim aimThroughLens(LenticularEyes eyes, uvec2 px) {
  float place = viewCoordinate(eyes.lens, px.x, px.y, eyes.channel);
  if (eyes.view_count > 0u) {
    place = (float(nearestView(place, eyes.view_count)) + 0.5) / float(eyes.view_count);
  }
  const float eye_m = eyes.distance_m * tangent(eyes.view_cone_rad * (place - 0.5));
  return Aim(vec2(px) + 0.5, vec2(eye_m, 0.0), true);
}

// The rays of a panel behind microlenses. A px is seen through the middle of its lens alone, so its
// ray is the line through both; from the px beside the middle by d, a focal length g behind it, it
// leans by d / g. Followed back to the plane of the display's eye, at a distance D from the lenses,
// it passes d / g D beside the lens.
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

// `px`: of the tile. `rays`: kRaysOf..., a constant of the kernel.
Aim aimOf(vec2 px, uint rays) {
  if (rays == kRaysOfMicrolenses) return aimThroughMicrolens(extras.microlenses, px);
  if (rays == kRaysOfLenticular) return aimThroughLens(extras.lenticular, uvec2(px));
  return Aim(px, vec2(0.0), true);
}

#endif  // VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_
