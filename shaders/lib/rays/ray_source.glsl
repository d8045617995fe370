// SPDX-License-Identifier: Apache-2.0
// Where the rays of px come from. A parameter that the kernel sets: kRays.
#ifndef VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_
#define VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_

#include "lib/rays/aim.glsl"
#include "lib/rays/extras.glsl"
#include "lib/rays/lenticular_rays.glsl"
#include "lib/rays/microlens_rays.glsl"

// `px`: of the tile.
Aim aimOf(vec2 px) {
  if (kRays == kRaysOfMicrolenses) return aimThroughMicrolens(extras.microlenses, px);
  if (kRays == kRaysOfLenticular) return aimThroughLens(extras.lenticular, uvec2(px));
  return Aim(px, vec2(0.0), true);
}

#endif  // VIEWLOOM_LIB_RAYS_RAY_SOURCE_GLSL_
