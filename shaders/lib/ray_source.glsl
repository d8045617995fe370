// SPDX-License-Identifier: Apache-2.0
// Where the rays of px come from. The includer has kRays and extras.
#ifndef VIEWLOOM_LIB_RAY_SOURCE_GLSL_
#define VIEWLOOM_LIB_RAY_SOURCE_GLSL_

#include "lib/aim.glsl"
#include "lib/lenticular_rays.glsl"
#include "lib/microlens_rays.glsl"

// `px`: of the tile.
Aim aimOf(vec2 px) {
  if (kRays == kRaysOfMicrolenses) return aimThroughMicrolens(extras.microlenses, px);
  if (kRays == kRaysOfLenticular) return aimThroughLens(extras.lenticular, uvec2(px));
  return Aim(px, vec2(0.0), true);
}

#endif  // VIEWLOOM_LIB_RAY_SOURCE_GLSL_
