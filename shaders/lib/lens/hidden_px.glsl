// SPDX-License-Identifier: Apache-2.0
// Px of a lens that the host gathers whose middle ray ends behind something: listed, then walked
// by rays through the lens.
#ifndef VIEWLOOM_LIB_LENS_HIDDEN_PX_GLSL_
#define VIEWLOOM_LIB_LENS_HIDDEN_PX_GLSL_

#include "lib/lens/lens.glsl"
#include "lib/lens/lens_rays.glsl"
#include "lib/lens/traced_px.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/light/srgb.glsl"
#include "lib/light/store_px.glsl"
#include "lib/rays/tile_px.glsl"
#include "lib/rays/views.glsl"
#include "lib/walk/walk.glsl"
#include "lib/walk/walk_views.glsl"

bool endsBehind(Walk walk) {
  return !walk.is_hit && walk.ends_behind;
}

void listHidden(uint index) {
  const uint place = atomicAdd(incomplete.count, 1u);
  incomplete_list[place] = index;
  if (place % kTraceGroupSize == 0u) atomicAdd(incomplete.group_count.x, 1u);
}

// The mean of the first rays of a px through its lens, codes.
vec3 codesThroughLens(Scene scene, ViewParams view, uvec2 px, vec3 background) {
  vec3 light = vec3(0.0);
  uint point = 0u;
  for (;;) {
    if (isNever(scene, 12u)) break;
    const vec2 at = lens_points[point * kLensPatternArea_px + lensPatternIndex(px)];
    const vec2 place = vec2(px) + 0.5 + besideOf(point);
    const Traced ray = traceFromOwnEye(scene, viewThrough(view, at), place, background);
    light += linearFromSrgb(codesOfBlend(ray.seen.color, kColorFormat) / 255.0);
    ++point;
    if (point == kRaysOfHidden) break;
  }
  return codesFromLinear(light / float(kRaysOfHidden));
}

// A listed px. An invocation has no more than one: lavapipe ends all loops of an invocation after
// 65535 rounds of them together.
void traceHidden(Scene scene) {
  const uint entry = gl_GlobalInvocationID.x;
  const bool exists = entry < incomplete.count;
  const uint index = exists ? incomplete_list[entry] : 0u;
  const uint row = index / push.atlas_width_px;
  const TilePx at = tilePxAt(index - row * push.atlas_width_px, push.first_row + row,
                             push.tile_size_px, push.tile_grid, push.padding_top_px);
  const vec3 background = blendOfBackground(push.fill, kColorFormat);
  const vec3 codes = codesThroughLens(scene, views[at.tile], at.px, background);
  if (exists) storeHidden(index, codes);
}

#endif  // VIEWLOOM_LIB_LENS_HIDDEN_PX_GLSL_
