// SPDX-License-Identifier: Apache-2.0
// The walk: the first event of a ray (shaders/README.md, What a ray answers), found through the pyramid.
//
// Opaque layers are walked one after the other. Layer l + 1 lies behind layer l, so it is entered only
// where the ray first passed behind layer l, and followed only to the hit known so far. Cells are integers
// and move only along the ray, so every walk ends; there is no limit of steps.
#ifndef VIEWLOOM_LIB_WALK_GLSL_
#define VIEWLOOM_LIB_WALK_GLSL_

#include "lib/node.glsl"
#include "lib/ray.glsl"
#include "lib/structure_access.glsl"

// Levels of a walk beside those of the pyramid: a facet, and the flattened entry of a 4x4 cell.
const uint kAtFacet = 0u;
const uint kAtEntry = 1u;

const uint kAxisNone = 0u;  // in the ray's first column
const uint kAxisX = 1u;
const uint kAxisY = 2u;

// A place on the ray: where it entered `cell`, and across which axis.
struct Place {
  float t;
  ivec2 cell;
  uint axis;
};

struct Walk {
  bool is_hit;
  bool is_assumed;    // was behind known surface before the hit
  bool ends_behind;   // no hit, and behind known surface at the end
  bool leaves;        // no hit, and the end is not at inv_z = 0
  float t;            // of the hit; 1 without
  ivec2 cell;         // of the hit; the last column without
  uint layer;         // of the hit
  bool has_far_side;  // passed behind a silhouette: `far` is the column in front of it
  ivec2 far_cell;     // the surface there that the ray was in front of
  uint far_layer;
  uint visits;
};

// Starts behind the layers < behind_count at a place, in front of the others (a surface that was seen
// through). behind_count = kStateUnknown: in the state of its first column.
const uint kStateUnknown = 0xffu;

struct WalkStart {
  Place place;
  uint behind_count;
};

float facetAtPoint(StructureRef structure, uint layer, ivec2 cell, vec2 point) {
  const uvec2 facet = loadFacet(structure, layer, cell);
  const float inv_z = uintBitsToFloat(facet.x);
  return inv_z < 0.0 ? kNoSurface : facetAt(inv_z, unpackSlopes(facet.y), point - vec2(cell) - 0.5);
}

ivec2 stepOfAxis(uint axis, ivec2 direction) {
  return axis == kAxisX ? ivec2(direction.x, 0) : ivec2(0, direction.y);
}

// The edge of a facet that a ray comes in through (or, `leaving`, goes out through).
uint edgeOfAxis(uint axis, ivec2 direction, bool leaving) {
  const int along = axis == kAxisX ? direction.x : direction.y;
  const uint first = axis == kAxisX ? kEdgeLeft : kEdgeTop;
  return first + ((along > 0) == leaving ? 1u : 0u);
}

// The ray stands in front of layer `layer` before the edge and behind it after: is there a linked surface
// across the edge that it was in front of? Then it hits the edge.
bool hitsEdge(StructureRef structure, uint layer, Place place, ivec2 direction, vec3 point) {
  if (place.axis == kAxisNone) return false;
  const uint links = loadLinks(structure, layer, place.cell);
  const uint link = linkOfEdge(links, edgeOfAxis(place.axis, direction, false));
  if (link == 0u) return false;
  if (link - 1u >= layer) return true;
  const ivec2 before = place.cell - stepOfAxis(place.axis, direction);
  return point.z > facetAtPoint(structure, link - 1u, before, point.xy);
}

// A surface behind which the ray walks may come forward at the next edge: link to a lower layer, whose
// facet there the ray is then behind. Returns 1 + that layer, or 0.
uint forwardEdgeHit(StructureRef structure, uint layer, ivec2 cell, uint axis, ivec2 direction, vec3 point) {
  const uint links = loadLinks(structure, layer, cell);
  const uint link = linkOfEdge(links, edgeOfAxis(axis, direction, true));
  if (link == 0u || link - 1u >= layer) return 0u;
  const ivec2 after = cell + stepOfAxis(axis, direction);
  return point.z <= facetAtPoint(structure, link - 1u, after, point.xy) ? link : 0u;
}

Walk walkRay(StructureRef structure, Ray ray, WalkStart start, float inv_z_tolerance, float eye_z,
             float kappa_abs, float kappa_rel) {
  const uint layer_count = structure.value.layer_count;
  const ivec2 size = ivec2(structure.value.width_px, structure.value.height_px);
  const ivec2 direction = ivec2(ray.extent.x >= 0.0 ? 1 : -1, ray.extent.y >= 0.0 ? 1 : -1);
  // Along an axis that the ray does not move on, edges are out of reach.
  const vec2 reach = max(abs(ray.extent.xy), vec2(1e-30));
  const vec2 inverse_extent = vec2(direction) / reach;

  Walk result;
  result.is_hit = false;
  result.is_assumed = false;
  result.ends_behind = false;
  result.leaves = false;
  result.t = 1.0;
  result.cell = start.place.cell;
  result.layer = 0u;
  result.has_far_side = false;
  result.far_cell = start.place.cell;
  result.far_layer = 0u;
  result.visits = 0u;

  uint layer = 0u;
  uint level = kAtEntry;
  Place at = start.place;
  bool state_unknown = start.behind_count == kStateUnknown;
  bool in_front = !state_unknown && start.behind_count == 0u;
  // The cell a walk restarts in: its own surfaces stay behind it.
  bool just_left = !state_unknown && start.behind_count > 0u;
  if (just_left) level = kAtFacet;
  // Where the ray first passed behind this layer.
  bool has_passed = just_left;
  Place passed = start.place;
  bool passed_at_start = true;
  float first_passed_t = just_left ? start.place.t : 2.0;

  for (;;) {
    ++result.visits;
    uvec2 bits;
    if (level == kAtFacet) bits = loadFacet(structure, layer, at.cell);
    else if (level == kAtEntry) bits = loadEntry(structure, layer, uvec2(at.cell) >> kLevelFirst);
    else bits = loadNode(structure, layer, level, uvec2(at.cell) >> level);
    Node node = unpackNode(bits);
    if (level == kAtFacet) {
      const float inv_z = uintBitsToFloat(bits.x);
      node.is_plane = inv_z >= 0.0;
      node.level = 0u;
      node.inv_z = inv_z;
      node.error = 0.0;
      node.box = vec2(0.0, kNoSurface);
    }

    // The stretch of the ray inside the node.
    const int node_size = 1 << node.level;
    const ivec2 origin = (at.cell >> int(node.level)) << int(node.level);
    const vec2 exit_edge = vec2(origin) + vec2(direction.x > 0 ? node_size : 0, direction.y > 0 ? node_size : 0);
    const vec2 exit_t = (exit_edge - ray.start.xy) * inverse_extent;
    const float exit_at = max(min(exit_t.x, exit_t.y), at.t);
    const bool is_last = exit_at >= result.t;
    const float end_t = is_last ? result.t : exit_at;
    const vec3 from = ray.start + at.t * ray.extent;
    const vec3 to = ray.start + end_t * ray.extent;

    bool must_descend = false;
    bool hit_inside = false;
    bool passes_edge = false;
    float front_from = 0.0;
    float front_to = 0.0;
    if (node.is_plane) {
      const vec2 center = vec2(origin) + 0.5 * float(node_size);
      // Without the bound at the sky, so that the distance stays linear along the ray: above it both have
      // the same sign, and whoever arrives at the sky arrives at the surface.
      front_from = from.z - node.inv_z - dot(node.slope, from.xy - center);
      front_to = to.z - node.inv_z - dot(node.slope, to.xy - center);
      if (to.z <= 0.0) front_to = min(front_to, 0.0);
      const float nearness = 1.0 - from.z * eye_z;
      const bool accepted = node.error <= inv_z_tolerance * nearness * nearness;
      must_descend = !accepted && !(min(front_from, front_to) > node.error) &&
                     !(max(front_from, front_to) < -node.error);
      if (just_left) front_from = min(front_from, 0.0);
      passes_edge = in_front && !state_unknown && front_from <= 0.0;
      if (passes_edge && !must_descend) {
        hit_inside = hitsEdge(structure, layer, at, direction, from);
      }
    } else {
      const float nearest = max(from.z, to.z);
      const float farthest = min(from.z, to.z);
      // Distances to the box stand in for those to a surface; only their signs are used.
      const bool is_front = farthest > node.box.y;
      const bool is_behind = nearest < node.box.x;
      // How far apart linked facets are is bounded at the middle of their edge only: whoever comes in from
      // the front must look at the links.
      const bool can_link = in_front && !state_unknown;
      must_descend = !is_front && !(is_behind && !can_link);
      front_from = is_front ? 1.0 : -1.0;
      front_to = front_from;
      passes_edge = in_front && !state_unknown && !is_front;
    }
    if (must_descend) {
      // A box of 4x4 or larger was entered from its entry, which is the largest plane there is; a plane
      // that is too coarse has planes below it.
      level = node.level <= kLevelFirst ? kAtFacet : (node.is_plane ? node.level - 1u : kAtEntry);
      continue;
    }

    float hit_t = at.t;
    uint hit_layer = layer;
    ivec2 hit_cell = at.cell;
    if (!hit_inside) {
      const bool starts_in_front = state_unknown ? front_from > 0.0 : (in_front || front_from > 0.0) && !passes_edge;
      if (!has_passed && (passes_edge || (state_unknown && front_from <= 0.0))) {
        has_passed = true;
        passed = at;
        passed_at_start = state_unknown;
        if (layer == 0u) first_passed_t = at.t;
      }
      in_front = starts_in_front;
      state_unknown = false;
      just_left = false;
      if (in_front && front_to <= 0.0) {
        hit_inside = true;
        hit_t = at.t + (end_t - at.t) * (front_from / (front_from - front_to));
        const ivec2 cell = ivec2(floor((ray.start + hit_t * ray.extent).xy));
        hit_cell = clamp(cell, origin, origin + node_size - 1);
      } else {
        in_front = front_to > 0.0;
        if (in_front && layer > 0u && node.level == 0u && node.is_plane && !is_last) {
          const uint axis = exit_t.x <= exit_t.y ? kAxisX : kAxisY;
          const ivec2 after = at.cell + stepOfAxis(axis, direction);
          if (all(greaterThanEqual(after, ivec2(0))) && all(lessThan(after, size))) {
            const uint link = forwardEdgeHit(structure, layer, at.cell, axis, direction, to);
            if (link > 0u) {
              hit_inside = true;
              hit_t = end_t;
              hit_layer = link - 1u;
              hit_cell = after;
            }
          }
        }
      }
    }

    bool layer_done = hit_inside || is_last;
    if (hit_inside) {
      result.is_hit = true;
      result.t = hit_t;
      result.layer = hit_layer;
      result.cell = clamp(hit_cell, ivec2(0), size - 1);
    } else if (!is_last) {
      // On to the next cell. Cells never go back, whatever the rounding of `to`.
      const bool cross_x = exit_t.x <= exit_t.y;
      const ivec2 low = direction * at.cell;
      ivec2 next = ivec2(floor(to.xy));
      next = clamp(next, origin, origin + node_size - 1);
      next = direction * max(direction * next, low);
      if (cross_x) next.x = direction.x > 0 ? origin.x + node_size : origin.x - 1;
      else next.y = direction.y > 0 ? origin.y + node_size : origin.y - 1;
      const bool left_image = any(lessThan(next, ivec2(0))) || any(greaterThanEqual(next, size));
      if (left_image) {
        layer_done = true;
      } else {
        const bool same_block = all(equal(at.cell >> int(kLevelFirst), next >> int(kLevelFirst)));
        level = node.level == 0u ? (same_block ? kAtFacet : kAtEntry)
                                 : (node.is_plane ? kAtEntry : min(max(node.level, kLevelFirst) + 1u, kLevelLast));
        at = Place(end_t, next, cross_x ? kAxisX : kAxisY);
      }
    }
    if (!layer_done) continue;

    if (!result.is_hit && layer == 0u) {
      result.ends_behind = !in_front;
      result.cell = at.cell;
    }
    if (has_passed && !passed_at_start) {
      result.has_far_side = true;
      result.far_cell = passed.cell - stepOfAxis(passed.axis, direction);
      result.far_layer = layer;
    }
    if (!has_passed || layer + 1u >= layer_count) break;
    ++layer;
    at = passed;
    state_unknown = passed_at_start && start.behind_count == kStateUnknown;
    just_left = passed_at_start && !state_unknown && layer < start.behind_count;
    in_front = !state_unknown && !just_left;
    level = just_left ? kAtFacet : kAtEntry;
    has_passed = just_left;
  }
  result.is_assumed = result.is_hit && first_passed_t < result.t;
  result.leaves = !ray.is_endless;
  return result;
}

#endif  // VIEWLOOM_LIB_WALK_GLSL_
