// SPDX-License-Identifier: Apache-2.0
// The surface that is taken to go on behind what a ray ends behind.
#ifndef VIEWLOOM_LIB_WALK_FAR_SIDE_GLSL_
#define VIEWLOOM_LIB_WALK_FAR_SIDE_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/structure/structure_access.glsl"
#include "lib/walk/walk_edges.glsl"
#include "lib/walk/walk_state.glsl"
#include "shared/trace_abi.h"

// Whether a ray ended behind something and passed no silhouette whose other side is a surface: it
// passed one beside nothing, or went through what it ended behind.
bool lacksFarSide(Walk walk, WalkStart start) {
  const bool has_none = !walk.is_hit && walk.ends_behind && !walk.has_far_side;
  return has_none && (walk.far_axis != kAxisNone || start.behind_count > 0u);
}

// 1/Z a deep step before a surface: from there stepAt leads to it.
float deepBefore(vec3 deep, float inv_z) {
  return max(inv_z + deep.x, deep.z + (inv_z - deep.z) / (1.0 - deep.y));
}

// Looks away from what such a ray ended behind, at distances that double. Beside nothing for the
// first surface back along the ray that is not nearer by a deep step: samples may be missing beside
// what stands in front, as a sensor sees no more there; one that is as far is taken to go on over
// the hole, up to where the ray passed it. Beside what was gone through for the furthest, both ways
// along the ray, that is deeper by a deep step: soft edges may be wide. There may be none.
void findFarSide(Scene scene, Ray ray, WalkStart start, inout Walk walk) {
  if (!lacksFarSide(walk, start)) return;
  const bool is_beside = walk.far_axis != kAxisNone;
  const uint layer = is_beside ? 0u : max(start.behind_count, 1u) - 1u;
  const vec2 along = ray.extent.xy * min(ray.pace.x, ray.pace.y);
  const vec2 from = vec2(is_beside ? walk.far_cell : start.cell) + 0.5;
  const ivec2 direction = mix(ivec2(1), ivec2(-1), lessThan(ray.extent.xy, vec2(0.0)));
  const ivec2 near_cell = walk.far_cell + stepOfAxis(walk.far_axis, direction);
  const uvec2 near = loadFacet(scene.layers, 0u, scene.extent, near_cell);
  const float near_inv_z = is_beside ? facetInvZ(near) : ray.start.z + start.t * ray.extent.z;
  const int last_side = is_beside ? -1 : 1;
  const float deep_inv_z = near_inv_z - stepAt(scene.deep, near_inv_z);
  float bound = is_beside ? deepBefore(scene.deep, near_inv_z) : deep_inv_z;
  uint probe = 0u;
  for (;;) {
    if (isNever(scene, 6u)) break;
    for (int side = -1; side <= last_side; side += 2) {
      const ivec2 cell = ivec2(floor(from + float(side * (1 << int(probe))) * along));
      const ivec2 inside = clamp(cell, ivec2(0), scene.extent.size_px - 1);
      const float inv_z = facetInvZ(loadFacet(scene.layers, layer, scene.extent, inside));
      const bool is_further = inv_z >= 0.0 && inv_z < bound;
      const ivec2 far_cell = inv_z < deep_inv_z ? inside : near_cell;
      walk.far_cell = is_further ? far_cell : walk.far_cell;
      walk.far_layer = is_further ? layer : walk.far_layer;
      walk.has_far_side = is_further || walk.has_far_side;
      walk.far_share = is_further ? 0.0 : walk.far_share;
      bound = is_further ? inv_z : bound;
    }
    ++probe;
    if (probe == kFarSideProbes || (is_beside && walk.has_far_side)) break;
  }
}

// Where the far side of a silhouette is looked up: in the middle of its column, towards the near
// side as far as the ray was up the step, if that is not deep.
vec2 farPoint(Ray ray, Walk walk) {
  const vec2 cell = vec2(walk.far_cell);
  const vec2 passed = clamp((ray.start + walk.far_t * ray.extent).xy, cell, cell + 1.0);
  const vec2 along = cell + 0.5 + walk.far_share * sign(ray.extent.xy);
  return walk.far_axis == kAxisX   ? vec2(along.x, passed.y)
         : walk.far_axis == kAxisY ? vec2(passed.x, along.y)
                                   : cell + 0.5;
}

#endif  // VIEWLOOM_LIB_WALK_FAR_SIDE_GLSL_
