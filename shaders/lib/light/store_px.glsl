// SPDX-License-Identifier: Apache-2.0
// Where the answer of a ray goes: the planes of a band.
#ifndef VIEWLOOM_LIB_LIGHT_STORE_PX_GLSL_
#define VIEWLOOM_LIB_LIGHT_STORE_PX_GLSL_

#include "lib/light/edge_blend.glsl"
#include "lib/rays/extras.glsl"
#include "lib/walk/met_surface.glsl"
#include "lib/rays/ray.glsl"
#include "lib/walk/ray_answer.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/walk/walk.glsl"
#include "lib/walk/walk_views.glsl"

void storeCodes(uint index, vec3 codes) {
  if ((kWanted & kWantSum) != 0u) {
    const vec3 light = linearFromSrgb(codes / 255.0);
    sums[index] = (push.fill & kFillFirst) != 0u ? light : sums[index] + light;
    return;
  }
  band[index] = packCodes(codes);
  if ((kWanted & kWantLinear) != 0u) {
    Vec4Ref(extras.linear).at[index] = vec4(clamp(codes / 255.0, 0.0, 1.0), 1.0);
  }
}

// Alpha 0 says that what the px shows is hidden.
void storeHidden(uint index, vec3 codes) {
  storeCodes(index, codes);
  band[index] = packCodes(codes) & ~kOpaqueCode;
}

void storeColor(uint index, Seen seen) {
  storeCodes(index, codesOfBlend(seen.color, kColorFormat));
}

// 1/Z of the view; 0 where nothing is hit.
float depthOf(Walk walk, Ray ray, vec3 eye, vec3 direction) {
  const vec3 point = ray.start + walk.t * ray.extent;
  return walk.is_hit ? viewInvZ(eye, direction, point) : 0.0;
}

// Stores a pixel of a tile, before edges are looked for. `inv_z`: for tiles that show depth.
void storeShown(uint index, ViewParams view, Seen seen, float inv_z) {
  const bool shows_depth = (kShownBeside & view.shows & kShowsDepth) != 0u;
  const vec3 grey = vec3(float(depthCode(inv_z, extras.depth_scale)));
  storeCodes(index, shows_depth ? grey : codesOfBlend(seen.color, kColorFormat));
}

void storeOthers(uint index, Walk walk, bool is_known, Ray ray, vec3 eye, vec3 direction) {
  if (kWanted == 0u) return;
  const vec3 point = ray.start + walk.t * ray.extent;
  const uint ray_class = classOf(walk);
  if ((kWanted & kWantDepth) != 0u) {
    FloatRef(extras.depth).at[index] = depthOf(walk, ray, eye, direction);
  }
  if ((kWanted & kWantMask) != 0u) Uint8Ref(extras.mask).at[index] = uint8_t(ray_class);
  if ((kWanted & kWantMet) != 0u) UintRef(extras.met).at[index] = nameOfMet(walk, is_known);
  if ((kWanted & kWantRecords) != 0u) {
    RecordsRef(extras.records).at[index] =
        RayRecord(point.x, point.y, point.z, ray_class, walk.layer, walk.visits);
  }
}

#endif  // VIEWLOOM_LIB_LIGHT_STORE_PX_GLSL_
