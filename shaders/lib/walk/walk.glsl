// SPDX-License-Identifier: Apache-2.0
// The walk: the first event of a ray (shaders/walk.md, What a ray answers), found through the
// pyramid.
//
// Opaque layers are walked one after the other. Layer l + 1 lies behind layer l, so it is entered
// only where the ray first passed behind layer l, and followed only to the hit known so far. Cells
// are integers and move only along the ray, so every walk ends; there is no limit of steps.
//
// Rays are mirrored so that they go up along x and y: cell c of the image is cell ~c = -1 - c of
// the mirrored one, and whole blocks stay whole blocks. Only addresses and slopes need the mirror
// undone.
//
// Two loops: the inner one steps from cell to cell, one load a visit and no branch; what is rare
// (an edge that may be linked, the end of a layer) stops it and is dealt with by the outer one.
#ifndef VIEWLOOM_LIB_WALK_WALK_GLSL_
#define VIEWLOOM_LIB_WALK_WALK_GLSL_

#include "lib/fault.glsl"
#include "lib/structure/node.glsl"
#include "lib/rays/ray.glsl"
#include "lib/structure/structure_access.glsl"
#include "lib/walk/walk_edges.glsl"
#include "lib/walk/walk_state.glsl"

// Rounding of the distance to a facet, as a share of the ray's own inv_z: 16 ulp, from positions
// along a ray and a few sums. The error of a plane may raise the largest inv_z in the source.
const float kRounding = 16.0 / 8388608.0;
const uvec4 kLayers = uvec4(0u, 1u, 2u, 3u);

Walk walkRay(Scene scene, WalkRules rules, Ray ray, WalkStart start, float inv_z_tolerance,
             float eye_z) {
  const bvec2 goes_back = lessThan(ray.extent.xy, vec2(0.0));
  const ivec2 flip = mix(ivec2(0), ivec2(-1), goes_back);
  const uint slope_flip = (goes_back.x ? kSlopeSigns.x : 0u) | (goes_back.y ? kSlopeSigns.y : 0u);
  const vec2 start_px = mix(ray.start.xy, -ray.start.xy, goes_back);
  const vec2 extent_px = abs(ray.extent.xy);
  const ivec2 last_cell = (scene.extent.size_px - 1) | flip;
  const ivec2 direction = 1 | flip;

  Walk result;
  result.is_hit = false;
  result.ends_behind = false;
  result.leaves = !ray.is_endless;
  result.t = ray.t_end;
  result.cell = start.cell;
  result.layer = 0u;
  result.level = kLevelFacets;
  result.has_far_side = false;
  result.far_cell = start.cell;
  result.far_layer = 0u;
  result.far_t = 0.0;
  result.far_axis = kAxisNone;
  result.far_share = 0.0;
  result.is_back = false;
  result.visits = 0u;

  uint layer = 0u;
  // The cell a walk restarts in: the surfaces that it starts behind stay behind it.
  bool just_left =
      rules.sees_through && start.behind_count != kStateUnknown && start.behind_count > 0u;
  Place at = Place(start.t, start.cell ^ flip, kAxisNone);
  // A ray in its first column counts as in front until it is seen not to be.
  bool in_front = !just_left;
  uint level = just_left ? kLevelFacets : kLevelEntries;
  // Where the ray first passed behind this layer.
  bool has_passed = just_left;
  Place passed = at;
  // How far back the far side of the silhouette lies that it passed behind last.
  float far_inv_z = kNoSurface;
  // Where nothing of a layer is hit any more: the ray met the far side of it, or of a deeper one.
  vec4 over_t = vec4(2.0);
  float first_passed_t = just_left ? start.t : 2.0;
  // The last visit: its level, where the ray left it, how far in front it was there and before.
  uint own_level = 0u;
  float end_t = 0.0;
  float front_from = 0.0;
  float front_to = 0.0;
  bool met_far = false;

  for (;;) {
    if (isNever(scene, 1u)) break;
    uint event = kEnds;
    for (;;) {
      if (isNever(scene, 2u)) break;
      ++result.visits;
      const uint shift = level == kLevelEntries ? kLevelFirst : level;
      const uvec2 block = uvec2(at.cell ^ flip) >> shift;
      const uint index = cellIndex(scene.extent, level, block);
      const uvec2 bits = loadWord(scene.layers, layer, scene.extent, index);
      const bool is_facet = level == kLevelFacets;
      const bool is_plane = is_facet ? bits.x != kNoFacet : isPlane(bits);
      own_level = is_facet ? 0u : bits.x & 7u;

      // The stretch of the ray inside.
      const int size_px = 1 << own_level;
      const ivec2 end_cell = at.cell | (size_px - 1);
      const vec2 edge = vec2(end_cell + 1);
      const vec2 exit_t = (edge - start_px) * ray.pace;
      const bool cross_x = exit_t.x <= exit_t.y;
      const float exit_at = max(cross_x ? exit_t.x : exit_t.y, at.t);
      const bool is_last = exit_at >= result.t;
      end_t = is_last ? result.t : exit_at;
      const vec2 from = start_px + at.t * extent_px;
      const vec2 to = start_px + end_t * extent_px;
      const float from_inv_z = ray.start.z + at.t * ray.extent.z;
      const float to_inv_z = ray.start.z + end_t * ray.extent.z;

      // How far in front of the plane, or of the box: only the signs count for a box.
      vec2 center = edge - 0.5 * float(size_px);
      if (hasFault(kFaultPlaneOff)) center.x += 1.0;
      const float inv_z = uintBitsToFloat(bits.x & (is_facet ? 0x7fffffffu : 0x7ffffe00u));
      const vec2 slope = unpackSlopes(bits.y ^ slope_flip);
      const float error = is_facet ? 0.0 : planeError(bits);
      // Without the bound at the sky, so that the distance stays linear along the ray: above it
      // both have the same sign, and whoever arrives at the sky arrives at the surface.
      const float plane_from = from_inv_z - inv_z - dot(slope, from - center);
      const float above_to = to_inv_z - inv_z - dot(slope, to - center);
      const float plane_to = to_inv_z <= 0.0 && above_to > 0.0 ? 0.0 : above_to;
      // Where the picture shows the error largest, it also has to be within the tolerance.
      const float nearness = min(abs(1.0 - from_inv_z * eye_z), abs(1.0 - to_inv_z * eye_z));
      const bool is_accepted =
          hasFault(kFaultErrorIgnored) || error <= inv_z_tolerance * nearness * nearness;
      // Planes are solved for rays that come closer. Who moves away meets nothing but the roughness
      // that a plane leaves out, and comes out where the facets say so. They also say who is behind
      // one at its edge where its error leaves a doubt.
      const bool knows_side = (in_front && at.axis != kAxisNone) || plane_from <= -error ||
                              plane_from > (in_front ? 0.0 : error);
      const bool is_exact =
          is_plane && is_accepted && (is_facet || (above_to <= plane_from && knows_side));
      const float box_low = is_facet ? 0.0 : uintBitsToFloat(bits.x & 0x7ffffff8u);
      const float box_high = is_facet ? kNoSurface : uintBitsToFloat(bits.y);
      const bool all_front = is_plane ? plane_from > error && plane_to > error
                                      : from_inv_z > box_high && to_inv_z > box_high;
      const bool all_behind = is_plane ? plane_from < -error && plane_to < -error
                                       : from_inv_z < box_low && to_inv_z < box_low;
      const bool is_decided = is_exact || all_front || all_behind;
      front_from = is_exact ? plane_from : all_front ? 1.0 : -1.0;
      front_to = is_exact ? plane_to : front_from;
      // Out from behind a plane that falls below the sky before the ray ends there.
      const bool still_behind = rules.sees_through && just_left;
      const bool comes_out_over_sky =
          is_exact && !still_behind && to_inv_z <= 0.0 && above_to > error;
      front_from = still_behind ? min(front_from, 0.0) : front_from;
      just_left = still_behind && !is_decided;
      if (hasFault(kFaultEntryInFront) && at.axis == kAxisNone) front_from = max(front_from, 1e-9);

      // How far apart linked facets are is bounded at the middle of their edge only, so whoever
      // passes to behind must look at the links.
      const bool meets_edge = is_decided && in_front && front_from <= 0.0;
      const bool passes = is_decided && !meets_edge;
      // Condition: as far back as the far side, while still behind the surface before it.
      const float from_far = from_inv_z - far_inv_z;
      const float far_to = far_inv_z - to_inv_z;
      const float front_at_end = is_exact ? above_to : front_from;
      met_far = passes && !in_front && front_from <= 0.0 && far_to >= 0.0 &&
                front_from * far_to + front_at_end * from_far <= 0.0;
      const bool hits =
          passes && !met_far && (front_from > 0.0 || comes_out_over_sky) && front_to <= 0.0;
      const bool meets_backs = rules.meets_backs && !hasFault(kFaultBacksPassed);
      const bool comes_out = meets_backs && passes && !met_far && !in_front && !still_behind &&
                             (front_from > 0.0 || front_to > 0.0);
      // A ray that comes out by less than rounding might meet the next facet as a step up.
      const float least_front = front_from > 0.0 ? 0.0 : kRounding * max(from_inv_z, to_inv_z);
      in_front = passes && !met_far ? front_to > least_front : in_front;

      // On to the next cell. Cells never go back, whatever the rounding of `to`.
      const ivec2 inside = clamp(ivec2(floor(to)), at.cell, end_cell);
      const ivec2 next = mix(inside, end_cell + 1, bvec2(cross_x, !cross_x));
      const bool ends = is_last || met_far || any(greaterThan(next, last_cell));
      const bool steps = passes && !hits && !ends && !comes_out;
      const bool leads_forward =
          is_facet && is_plane && in_front && (bits.x & kForwardLinkFlag) != 0u;
      event = meets_edge      ? kMeetsEdge
              : comes_out     ? kComesOut
              : hits          ? kHits
              : !passes       ? kStepOn
              : ends          ? kEnds
              : leads_forward ? kComesForward
                              : kStepOn;
      const bool same_block = all(equal(at.cell >> int(kLevelFirst), next >> int(kLevelFirst)));
      const bool stays_low = hasFault(kFaultNeverClimbs) || same_block;
      const uint up = is_facet   ? (stays_low ? kLevelFacets : kLevelEntries)
                      : is_plane ? kLevelEntries
                                 : min(own_level + 1u, kLevelLast);
      // A box was reached from its entry, the largest plane there is; a plane has planes below it.
      const uint down = own_level <= kLevelFirst ? kLevelFacets
                        : is_plane               ? own_level - 1u
                                                 : kLevelEntries;
      level = is_decided ? (steps ? up : level) : down;
      at.t = steps ? end_t : at.t;
      at.cell = mix(at.cell, next, bvec2(steps));
      at.axis = steps ? (cross_x ? kAxisX : kAxisY) : at.axis;
      if (event != kStepOn) break;
    }

    // An edge: hit, or passed, and on from the same cell.
    const vec3 point = ray.start + at.t * ray.extent;
    const float nearness = 1.0 - point.z * eye_z;
    const Crossing crossing =
        meetEdge(scene, event, layer, Place(at.t, at.cell ^ flip, at.axis), direction, point,
                 ray.extent, inv_z_tolerance * nearness * nearness);
    const vec4 of_hit = vec4(equal(uvec4(crossing.hit_layer), kLayers));
    const bool hits_edge = crossing.hit_layer != kNoLayer && at.t <= dot(of_hit, over_t);
    bool goes_on = (event == kMeetsEdge || event == kComesForward) && !hits_edge;
    if (event == kMeetsEdge && !hits_edge) {
      if (!has_passed) passed = at;
      // The last one that it passes is the one that it ends behind, and the deepest layer the best
      // that has a surface there.
      if (crossing.has_far_side || (crossing.is_from_nothing && layer == 0u)) {
        result.has_far_side = crossing.has_far_side;
        result.far_cell = (at.cell ^ flip) - stepOfAxis(at.axis, direction);
        result.far_layer = layer;
        result.far_t = at.t;
        result.far_axis = at.axis;
        result.far_share = crossing.far_share;
      }
      has_passed = true;
      in_front = false;
      far_inv_z = crossing.far_inv_z;
    }
    // Out from behind a surface; between two facets of it, or past its end.
    const bool leaves_surface = rules.meets_backs && event == kComesOut;
    const bool passes_end = leaves_surface && front_from > 0.0 &&
                            !goesOnBefore(scene, layer, Place(at.t, at.cell ^ flip, at.axis),
                                          direction);
    const bool meets_back = leaves_surface && !passes_end;
    in_front = in_front || passes_end;
    goes_on = goes_on || passes_end;
    // Where in the last block the ray hits, or ends.
    const bool is_out_already = leaves_surface && front_from > 0.0;
    const bool crosses_inside = !is_out_already && (front_from > 0.0) != (front_to > 0.0);
    const float inside_share = crosses_inside ? front_from / (front_from - front_to) : 0.0;
    const float share = event == kHits && front_from <= 0.0 ? 1.0 : inside_share;
    const float last_t = event == kEnds ? end_t : at.t + (end_t - at.t) * share;
    const ivec2 block_end = at.cell | int((1u << own_level) - 1u);
    const ivec2 cell = ivec2(floor(start_px + last_t * extent_px));
    const ivec2 inside = clamp(cell, at.cell, min(block_end, last_cell)) ^ flip;
    if (event == kHits || hits_edge || meets_back) {
      result.is_hit = true;
      result.is_back = meets_back;
      result.t = hits_edge ? at.t : last_t;
      result.cell = hits_edge ? at.cell ^ flip : inside;
      result.layer = hits_edge ? crossing.hit_layer : layer;
      result.level = hits_edge ? kLevelFacets : own_level;
    }
    if (event == kEnds && layer == 0u) {
      result.ends_behind = !in_front;
      result.cell = inside;
    }
    // The far side goes on so far, and what was hit beyond lies behind it; or it ended before.
    const bool meets = event == kEnds && met_far;
    const float from_far = ray.start.z + at.t * ray.extent.z - far_inv_z;
    const float met_t = at.t - from_far / ray.extent.z;
    const vec2 mirrored = ray.start.xy + (2.0 * result.far_t - met_t) * ray.extent.xy;
    if (reachesAsFar(scene, meets, far_inv_z, mirrored)) {
      result.ends_behind = true;
      result.is_hit = false;
      result.is_back = false;
      result.t = ray.t_end;
      const bvec4 ends_here = lessThanEqual(kLayers, uvec4(layer));
      over_t = mix(over_t, min(over_t, vec4(met_t)), ends_here);
    } else if (meets) {
      far_inv_z = kNoSurface;
      goes_on = true;
    }

    // This layer is done; the next begins where the ray passed behind it.
    if (!goes_on && has_passed) {
      if (layer == 0u) first_passed_t = passed.t;
      goes_on = layer + 1u < scene.layer_count && !hasFault(kFaultLayerDropped);
      ++layer;
      at = passed;
      just_left = rules.sees_through && passed.axis == kAxisNone &&
                  start.behind_count != kStateUnknown && layer < start.behind_count;
      in_front = !just_left;
      level = just_left ? kLevelFacets : kLevelEntries;
      has_passed = just_left;
      far_inv_z = kNoSurface;
    }
    if (!goes_on) break;
  }
  result.passed_t = first_passed_t;
  result.is_assumed = result.is_hit && first_passed_t < result.t;
  return result;
}

#endif  // VIEWLOOM_LIB_WALK_WALK_GLSL_
