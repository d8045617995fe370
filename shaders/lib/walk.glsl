// SPDX-License-Identifier: Apache-2.0
// The walk: the first event of a ray (shaders/README.md, What a ray answers), found through the
// pyramid.
//
// Opaque layers are walked one after the other. Layer l + 1 lies behind layer l, so it is entered
// only where the ray first passed behind layer l, and followed only to the hit known so far. Cells
// are integers and move only along the ray, so every walk ends; there is no limit of steps.
//
// Two loops: the inner one steps from cell to cell, one load a visit; what is rare (an edge that
// may be linked, the end of a layer) stops it and is dealt with by the outer one. On devices that
// mask instead of branching, rare code inside the inner loop would cost every visit.
#ifndef VIEWLOOM_LIB_WALK_GLSL_
#define VIEWLOOM_LIB_WALK_GLSL_

#include "lib/fault.glsl"
#include "lib/node.glsl"
#include "lib/ray.glsl"
#include "lib/structure_access.glsl"
#include "lib/walk_edges.glsl"

// A walk begins in the state of its first column (kStateUnknown), or behind the layers <
// behind_count and in front of the others, at a surface that was seen through.
const uint kStateUnknown = 0xffu;

// Of the distance to a facet, as a share of the ray's own inv_z: 16 ulp, the rounding of positions
// along a ray and a few of the sums. Not of the largest in the source, which the error of a plane
// may have raised.
const float kRounding = 16.0 / 8388608.0;

struct WalkStart {
  Place place;
  uint behind_count;
};

struct Walk {
  bool is_hit;
  bool is_assumed;    // was behind known surface before the hit
  bool ends_behind;   // no hit, and behind known surface at the end
  bool leaves;        // the ray's end is not at inv_z = 0
  float t;            // of the hit; 1 without
  ivec2 cell;         // of the hit; the last column without
  uint layer;         // of the hit
  bool has_far_side;  // passed behind a silhouette: the column in front of it, and the layer there
  ivec2 far_cell;     // whose surface the ray was in front of
  uint far_layer;
  uint visits;
};

Walk walkRay(Scene scene, Ray ray, WalkStart start, float inv_z_tolerance, float eye_z) {
  const ivec2 direction = ivec2(ray.extent.x >= 0.0 ? 1 : -1, ray.extent.y >= 0.0 ? 1 : -1);
  const ivec2 forward = max(direction, ivec2(0));
  // Along an axis that the ray does not move on, edges are out of reach.
  const vec2 inverse_extent = vec2(direction) / max(abs(ray.extent.xy), vec2(1e-30));
  const uint area = scene.extent.padded_area;

  Walk result;
  result.is_hit = false;
  result.ends_behind = false;
  result.t = 1.0;
  result.cell = start.place.cell;
  result.layer = 0u;
  result.has_far_side = false;
  result.far_cell = start.place.cell;
  result.far_layer = 0u;
  result.visits = 0u;

  uint layer = 0u;
  Place at = start.place;
  bool state_unknown = start.behind_count == kStateUnknown;
  bool in_front = start.behind_count == 0u;
  // The cell a walk restarts in: the surfaces that it starts behind stay behind it.
  bool just_left = !state_unknown && start.behind_count > 0u;
  uint level = just_left ? kLevelFacets : kLevelEntries;
  bool from_forward_link = false;
  // Where the ray first passed behind this layer.
  bool has_passed = just_left;
  bool passed_at_start = true;
  Place passed = start.place;
  float first_passed_t = just_left ? start.place.t : 2.0;
  ivec2 hit_origin = ivec2(0);
  int hit_size = 1;
  float hit_t = 1.0;

  for (;;) {
    uint event = from_forward_link ? kComesForward : kStepOn;
    while (event == kStepOn) {
      ++result.visits;
      const uint shift = level == kLevelEntries ? kLevelFirst : level;
      const uvec2 block = uvec2(at.cell) >> shift;
      const uint index =
          levelOffset(level, area) + block.y * (scene.extent.padded_width >> shift) + block.x;
      const uvec2 bits = loadWord(scene.layers, layer, scene.extent, index);
      const bool is_facet = level == kLevelFacets;
      const bool is_plane = is_facet ? bits.x != kNoFacet : isPlane(bits);
      const uint own_level = is_facet ? 0u : bits.x & 7u;

      // The stretch of the ray inside.
      const int size_px = 1 << own_level;
      const ivec2 origin = at.cell & ivec2(-size_px);
      const vec2 exit_t = (vec2(origin + forward * size_px) - ray.start.xy) * inverse_extent;
      const float exit_at = max(min(exit_t.x, exit_t.y), at.t);
      const bool is_last = exit_at >= result.t;
      const float end_t = min(exit_at, result.t);
      const vec3 from = ray.start + at.t * ray.extent;
      const vec3 to = ray.start + end_t * ray.extent;

      // How far in front of the plane, or of the box: only the signs count for a box.
      vec2 center = vec2(origin) + 0.5 * float(size_px);
      if (hasFault(kFaultPlaneOff)) center.x += 1.0;
      const float inv_z = uintBitsToFloat(bits.x & (is_facet ? 0x7fffffffu : 0x7ffffe00u));
      const vec2 slope = unpackSlopes(bits.y);
      const float error = is_facet ? 0.0 : planeError(bits);
      // Without the bound at the sky, so that the distance stays linear along the ray: above it
      // both have the same sign, and whoever arrives at the sky arrives at the surface.
      const float plane_from = from.z - inv_z - dot(slope, from.xy - center);
      const float above_to = to.z - inv_z - dot(slope, to.xy - center);
      const float plane_to = to.z <= 0.0 ? min(above_to, 0.0) : above_to;
      // Where the picture shows the error largest, it also has to be within the tolerance.
      const float nearness = min(abs(1.0 - from.z * eye_z), abs(1.0 - to.z * eye_z));
      const bool is_accepted =
          hasFault(kFaultErrorIgnored) || error <= inv_z_tolerance * nearness * nearness;
      // Planes are solved for rays that come closer. Who moves away meets nothing but the roughness
      // that a plane leaves out, and comes out where the facets say so. They also say who is behind
      // one at its edge where its error leaves a doubt.
      const bool is_decided =
          in_front || plane_from <= -error || plane_from > (state_unknown ? 0.0 : error);
      const bool is_exact =
          is_plane && is_accepted && (is_facet || (above_to <= plane_from && is_decided));
      const float box_low = is_facet ? 0.0 : uintBitsToFloat(bits.x & 0x7ffffff8u);
      const float box_high = is_facet ? kNoSurface : uintBitsToFloat(bits.y);
      const bool all_front =
          is_plane ? min(plane_from, plane_to) > error : min(from.z, to.z) > box_high;
      const bool all_behind =
          is_plane ? max(plane_from, plane_to) < -error : max(from.z, to.z) < box_low;
      if (!(is_exact || all_front || all_behind)) {
        // A box was reached from its entry, the largest plane there is; a plane has planes below
        // it.
        level = own_level <= kLevelFirst ? kLevelFacets : is_plane ? own_level - 1u : kLevelEntries;
        continue;
      }
      float front_from = is_exact ? plane_from : all_front ? 1.0 : -1.0;
      const float front_to = is_exact ? plane_to : front_from;
      // Out from behind a plane that falls below the sky before the ray ends there.
      const bool comes_out_over_sky =
          is_exact && !just_left && to.z <= 0.0 && above_to > error;
      front_from = just_left ? min(front_from, 0.0) : front_from;
      if (hasFault(kFaultEntryInFront) && state_unknown) front_from = max(front_from, 1e-9);

      // How far apart linked facets are is bounded at the middle of their edge only, so whoever
      // passes to behind must look at the links.
      if (in_front && front_from <= 0.0) {
        event = kMeetsEdge;
        continue;
      }
      if (state_unknown && front_from <= 0.0) {
        has_passed = true;
        passed = at;
      }
      in_front = front_from > 0.0;
      state_unknown = false;
      just_left = false;
      if ((in_front || comes_out_over_sky) && front_to <= 0.0) {
        event = kHits;
        const float share = in_front ? front_from / (front_from - front_to) : 1.0;
        hit_t = at.t + (end_t - at.t) * share;
        hit_origin = origin;
        hit_size = size_px;
        continue;
      }
      // Who comes out by less than rounding might meet the next facet as a step up.
      in_front = front_to > (front_from > 0.0 ? 0.0 : kRounding * max(from.z, to.z));

      // On to the next cell. Cells never go back, whatever the rounding of `to`.
      const bool cross_x = exit_t.x <= exit_t.y;
      ivec2 next = clamp(ivec2(floor(to.xy)), origin, origin + size_px - 1);
      next = direction * max(direction * next, direction * at.cell);
      const ivec2 beyond = origin + forward * (size_px + 1) - 1;
      next = cross_x ? ivec2(beyond.x, next.y) : ivec2(next.x, beyond.y);
      if (is_last || !isInside(scene.extent, next)) {
        event = kEnds;
        continue;
      }
      const bool same_block = all(equal(at.cell >> int(kLevelFirst), next >> int(kLevelFirst)));
      level = is_facet ? (same_block ? kLevelFacets : kLevelEntries)
                       : (is_plane ? kLevelEntries : min(own_level + 1u, kLevelLast));
      if (hasFault(kFaultNeverClimbs) && is_facet) level = kLevelFacets;
      from_forward_link = is_facet && is_plane && in_front && (bits.x & kForwardLinkFlag) != 0u;
      event = from_forward_link ? kComesForward : kStepOn;
      at = Place(end_t, next, cross_x ? kAxisX : kAxisY);
    }

    // An edge: hit, or passed, and on from the same cell.
    from_forward_link = false;
    if (event == kMeetsEdge || event == kComesForward) {
      const vec3 point = ray.start + at.t * ray.extent;
      const float nearness = 1.0 - point.z * eye_z;
      const float tolerance = inv_z_tolerance * nearness * nearness;
      const uint edge_hit =
          edgeHit(scene, event, layer, at, direction, point, ray.extent, tolerance);
      if (edge_hit == 0u) {
        if (event == kMeetsEdge) {
          if (!has_passed) passed = at;
          passed_at_start = has_passed && passed_at_start;
          has_passed = true;
          in_front = false;
        }
        continue;
      }
      result.is_hit = true;
      result.t = at.t;
      result.cell = at.cell;
      result.layer = edge_hit - 1u;
    } else if (event == kHits) {
      result.is_hit = true;
      result.t = hit_t;
      const ivec2 cell = ivec2(floor((ray.start + hit_t * ray.extent).xy));
      result.cell =
          min(clamp(cell, hit_origin, hit_origin + hit_size - 1), scene.extent.size_px - 1);
      result.layer = layer;
    } else if (layer == 0u) {
      result.ends_behind = !in_front;
      result.cell = at.cell;
    }

    // This layer is done; the next begins where the ray passed behind it.
    if (layer == 0u && has_passed) first_passed_t = passed.t;
    // The far side that lies furthest back is the best one, where there is a surface at all.
    const ivec2 far_cell =
        passed.cell - (has_passed ? stepOfAxis(passed.axis, direction) : ivec2(0));
    const uvec2 far_facet = loadFacet(scene.layers, layer, scene.extent, far_cell);
    if (has_passed && !passed_at_start && far_facet.x != kNoFacet) {
      result.has_far_side = true;
      result.far_cell = far_cell;
      result.far_layer = layer;
    }
    if (!has_passed || layer + 1u >= scene.layer_count || hasFault(kFaultLayerDropped)) break;
    ++layer;
    at = passed;
    state_unknown = passed_at_start && start.behind_count == kStateUnknown;
    just_left = passed_at_start && !state_unknown && layer < start.behind_count;
    in_front = !state_unknown && !just_left;
    level = just_left ? kLevelFacets : kLevelEntries;
    has_passed = just_left;
    passed_at_start = true;
  }
  result.is_assumed = result.is_hit && first_passed_t < result.t;
  result.leaves = !ray.is_endless;
  return result;
}

#endif  // VIEWLOOM_LIB_WALK_GLSL_
