// SPDX-License-Identifier: Apache-2.0
// What a walk meets on the edges between columns: the links that the ray crosses.
#ifndef VIEWLOOM_LIB_WALK_EDGES_GLSL_
#define VIEWLOOM_LIB_WALK_EDGES_GLSL_

#include "lib/fault.glsl"
#include "lib/node.glsl"
#include "lib/structure_access.glsl"

// What is walked through.
struct Scene {
  Address layers[kLayerCountMax];
  uint layer_count;
  Extent extent;
  float inv_z_near;  // nothing is nearer, 1/m
  vec2 kappa;        // connection tolerance: absolute (1/m), relative
};

const uint kAxisNone = 0u;  // in the ray's first column
const uint kAxisX = 1u;
const uint kAxisY = 2u;

// A place on the ray: where it entered `cell`, and across which axis.
struct Place {
  float t;
  ivec2 cell;
  uint axis;
};

// Why a walk stops stepping from cell to cell.
const uint kStepOn = 0u;
const uint kMeetsEdge = 1u;  // from in front to behind across an edge that may be linked
// The last facet has a link to a lower layer; it may stand before the ray.
const uint kComesForward = 2u;
const uint kHits = 3u;  // inside a node
const uint kEnds = 4u;  // the ray, or the stretch of it that is still of interest

ivec2 stepOfAxis(uint axis, ivec2 direction) {
  return axis == kAxisX ? ivec2(direction.x, 0) : axis == kAxisY ? ivec2(0, direction.y) : ivec2(0);
}

// The edge through which a ray leaves a facet across an axis, or comes in.
uint edgeOfAxis(uint axis, ivec2 direction, bool leaving) {
  const int along = axis == kAxisX ? direction.x : direction.y;
  const uint first = axis == kAxisX ? kEdgeLeft : kEdgeTop;
  return first + ((along > 0) == leaving ? 1u : 0u);
}

// How far the ray stands in front of a facet at a point of the facet's edge (x), and how far off
// that may be in favour of a hit (y): who comes closer is undecided where the walk of that layer
// may have taken a plane for the facet, by the error of the largest plane there or the tolerance.
vec2 inFrontOfFacet(Scene scene, uint layer, ivec2 cell, vec3 point, vec3 extent,
                    float tolerance) {
  const uvec2 facet = loadFacet(scene.layers, layer, scene.extent, cell);
  const float front = point.z - facetAtPoint(facet, cell, point.xy);
  const bool comes_closer = extent.z < dot(unpackSlopes(facet.y), extent.xy);
  const uvec2 entry =
      loadCell(scene.layers, layer, scene.extent, kLevelEntries, uvec2(cell) >> kLevelFirst);
  const bool is_undecided = comes_closer && isPlane(entry);
  return vec2(front, is_undecided ? min(tolerance, planeError(entry)) : 0.0);
}

// 1 + the layer whose surface the ray meets on the edge it has just crossed; 0 = none.
// kMeetsEdge: in front of the layers >= `layer` before, behind `layer` after: a link to any surface
// it was in front of is hit. kComesForward: in front of the layers >= `layer` before; hit if behind
// what one of them is linked to. Whoever is undecided and comes closer hits. `tolerance`, 1/m: the
// largest error of a plane that a walk takes here.
uint edgeHit(Scene scene, uint event, uint layer, Place at, ivec2 direction, vec3 point,
             vec3 extent, float tolerance) {
  if (at.axis == kAxisNone || hasFault(kFaultLinks)) return 0u;
  const ivec2 before = at.cell - stepOfAxis(at.axis, direction);
  const bool leaving = event == kComesForward;
  const uint edge = edgeOfAxis(at.axis, direction, leaving);
  if (!leaving) {
    if (hasFault(kFaultBehindIsHit)) return layer + 1u;
    const uint link = linkOfEdge(loadLinks(scene.layers, layer, scene.extent, at.cell), edge);
    if (link == 0u) return 0u;
    if (link - 1u >= layer) return layer + 1u;
    const vec2 front = inFrontOfFacet(scene, link - 1u, before, point, extent, tolerance);
    return front.x > -front.y ? layer + 1u : 0u;
  }
  for (uint from = layer; from < scene.layer_count; ++from) {
    const uint link = linkOfEdge(loadLinks(scene.layers, from, scene.extent, before), edge);
    if (link == 0u || link - 1u >= layer) continue;
    const vec2 front = inFrontOfFacet(scene, link - 1u, at.cell, point, extent, tolerance);
    if (front.x <= front.y) return link;
  }
  return 0u;
}

#endif  // VIEWLOOM_LIB_WALK_EDGES_GLSL_
