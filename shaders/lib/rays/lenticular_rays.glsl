// SPDX-License-Identifier: Apache-2.0
// The rays of a lenticular panel. Where a subpixel lies under its lens says which of the views it
// shows (shared/lenticular.h); the views' eyes lie on a line, at equal angles within the cone:
//   x = D tan(cone (z - 1/2)), z the place among the views, D the distance to the panel,
// which is where a quilt's eyes stand. A subpixel's ray leads from there through its own px.
#ifndef VIEWLOOM_LIB_RAYS_LENTICULAR_RAYS_GLSL_
#define VIEWLOOM_LIB_RAYS_LENTICULAR_RAYS_GLSL_

#include "lib/rays/aim.glsl"
#include "shared/trace_abi.h"

// Lambert's continued fraction, within 1e-7 of itself up to 1.3 rad: devices promise 2^-11.
float tangent(float angle_rad) {
  const float square = angle_rad * angle_rad;
  float part = 9.0 - square / 11.0;
  part = 7.0 - square / part;
  part = 5.0 - square / part;
  part = 3.0 - square / part;
  return angle_rad / (1.0 - square / part);
}

// `px`: of the panel, from its top left.
Aim aimThroughLens(LenticularEyes eyes, uvec2 px) {
  float place = viewCoordinate(eyes.lens, px.x, px.y, eyes.channel);
  if (eyes.view_count > 0u) {
    place = (float(nearestView(place, eyes.view_count)) + 0.5) / float(eyes.view_count);
  }
  const float eye_m = eyes.distance_m * tangent(eyes.view_cone_rad * (place - 0.5));
  return Aim(vec2(px) + 0.5, vec2(eye_m, 0.0), true);
}

#endif  // VIEWLOOM_LIB_RAYS_LENTICULAR_RAYS_GLSL_
