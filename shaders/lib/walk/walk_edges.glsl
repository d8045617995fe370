// SPDX-License-Identifier: Apache-2.0
// Meetings of a walk on the edges between columns: the links that the ray crosses.
#ifndef VIEWLOOM_LIB_WALK_WALK_EDGES_GLSL_
#define VIEWLOOM_LIB_WALK_WALK_EDGES_GLSL_

#include "lib/fault.glsl"
#include "lib/structure/structure_access.glsl"
#include "shared/trace_abi.h"

// Colour planes of a source.
struct ColorPlanes {
  Address texels[kLayerCountMax];  // of each layer
  uint format;                     // kColor...
  bool is_scaled;                  // they have another size than depth
};

// Structure that is walked through.
struct Scene {
  Address layers[kLayerCountMax];
  uint layer_count;
  Extent extent;
  float inv_z_near;   // a little in front of everything, 1/m
  float inv_z_range;  // that the source shows, 1/m
  vec3 kappa;         // steps within a surface (stepAt)
  vec3 deep;          // and between two things
  bool fills_border;  // else what leaves the image takes the background
  ColorPlanes color;  // where light is asked for
};

// Measurements of the build. Two of them are divisors, and never 0.
void addMeasured(inout Scene scene, MeasuredHead measured) {
  scene.inv_z_near = max(uintBitsToFloat(measured.inv_z_max_bits), kInvZNearMin) * kInvZNearMargin;
  scene.inv_z_range = max(measured.inv_z_near - measured.inv_z_far, kInvZNearMin);
  scene.kappa = connectedSteps(measured);
  scene.deep = deepSteps(measured);
}

// False, which no compiler knows; differs by `loop`, so that none knows it from the loop around.
// The head of every loop that lanes leave at its end one after the other: shaders/README.md, Loops.
bool isNever(Scene scene, uint loop) {
  return scene.layer_count == kLayerCountMax + 1u + loop;
}

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
const uint kComesOut = 5u;  // from behind a surface, to before it

ivec2 stepOfAxis(uint axis, ivec2 direction) {
  return axis == kAxisX ? ivec2(direction.x, 0) : axis == kAxisY ? ivec2(0, direction.y) : ivec2(0);
}

// The edge through which a ray leaves a facet across an axis, or comes in.
uint edgeOfAxis(uint axis, ivec2 direction, bool leaving) {
  const int along = axis == kAxisX ? direction.x : direction.y;
  const uint first = axis == kAxisX ? kEdgeLeft : kEdgeTop;
  return first + ((along > 0) == leaving ? 1u : 0u);
}

// Meeting of a ray with the edge it has just crossed.
struct Crossing {
  uint hit_layer;     // whose surface it hits; kNoLayer
  bool has_far_side;  // passes behind `layer`, from over a surface of it or from the beginning
  bool is_from_nothing;  // passes behind `layer`, from over no surface of it
  float far_share;    // how far up the step from that surface, 0..1; 0 if it is deep
  // 1/Z of that surface here, if it is behind the ray, and nothing says that it ends here; else
  // kNoSurface.
  float far_inv_z;
};

const uint kNoLayer = kLayerCountMax;

// kMeetsEdge: in front of the layers >= `layer` before, behind `layer` after: a link to any surface
// it was in front of is hit. kComesForward: in front of the layers >= `layer` before; hit if behind
// what one of them is linked to. Who comes closer is undecided within the largest error of a plane
// that the walk of the other layer may have taken for the facet, and hits: half of kappa, or the
// `tolerance`, 1/m, if that is less.
Crossing meetEdge(Scene scene, uint event, uint layer, Place at, ivec2 direction, vec3 point,
                  vec3 extent, float tolerance) {
  const ivec2 before = at.cell - stepOfAxis(at.axis, direction);
  const bool leaving = event == kComesForward;
  const bool crosses = at.axis != kAxisNone;
  const uint edge = edgeOfAxis(at.axis, direction, leaving);
  const ivec2 from_cell = leaving ? before : at.cell;
  const ivec2 to_cell = leaving ? at.cell : before;
  Crossing result = Crossing(kNoLayer, false, false, 0.0, kNoSurface);
  uint from = layer;
  for (;;) {
    if (isNever(scene, 3u)) break;
    const uint links = loadLinks(scene.layers, from, scene.extent, from_cell);
    const uint link = linkOfEdge(links, edge);
    const bool is_linked = link > 0u && crosses && !hasFault(kFaultLinks);
    const bool leads_forward = is_linked && link - 1u < layer;
    const uint to_layer = is_linked ? link - 1u : layer;
    const uvec2 facet = loadFacet(scene.layers, to_layer, scene.extent, to_cell);
    const float front = point.z - facetAtPoint(facet, to_cell, point.xy);
    const bool comes_closer = extent.z < dot(unpackSlopes(facet.y), extent.xy);
    const float error_max =
        0.5 * stepAt(scene.kappa, facetInvZ(facet));
    const float slack = comes_closer ? min(tolerance, error_max) : 0.0;
    if (leaving) {
      if (leads_forward && front <= slack) result.hit_layer = to_layer;
      ++from;
    } else if (event == kMeetsEdge) {
      const bool is_hit = is_linked && (!leads_forward || front > -slack);
      if (is_hit || (crosses && hasFault(kFaultBehindIsHit))) result.hit_layer = layer;
      result.has_far_side = !is_linked && facet.x != kNoFacet;
      result.is_from_nothing = !is_linked && facet.x == kNoFacet;
      const float far = point.z - front;
      const bool goes_on = result.has_far_side && crosses && front > 0.0 &&
                           !isKnownBehind(links, edge);
      result.far_inv_z = goes_on && !hasFault(kFaultFarSideEnds) ? far : kNoSurface;
      const float near =
          facetAtPoint(loadFacet(scene.layers, layer, scene.extent, at.cell), at.cell, point.xy);
      const bool is_deep = !crosses || near - stepAt(scene.deep, near) > far;
      result.far_share = is_deep ? 0.0 : clamp(front / max(near - far, 1e-30), 0.0, 1.0);
    }
    if (!leaving || result.hit_layer != kNoLayer || from == scene.layer_count) break;
  }
  return result;
}

// Whether the surface of a layer goes on from the column before a place: who was behind it there,
// and is not any more, has come through it.
bool goesOnBefore(Scene scene, uint layer, Place at, ivec2 direction) {
  const uint links = loadLinks(scene.layers, layer, scene.extent, at.cell);
  const uint edge = edgeOfAxis(at.axis, direction, false);
  return at.axis != kAxisNone && linkOfEdge(links, edge) == layer + 1u;
}

// Whether a far side that a ray has `met` is taken to go on as far as that: at the place mirrored
// where the ray passed it, some layer holds a surface as far back, or the image has ended.
bool reachesAsFar(Scene scene, bool met, float far_inv_z, vec2 mirrored) {
  const ivec2 column = ivec2(floor(mirrored));
  const bvec2 is_inside =
      bvec2(all(greaterThanEqual(column, ivec2(0))), all(lessThan(column, scene.extent.size_px)));
  const bool is_known = met && all(is_inside) && !hasFault(kFaultFarSideEndless);
  const ivec2 inside = clamp(column, ivec2(0), scene.extent.size_px - 1);
  bool reaches = met && !is_known;
  uint layer = 0u;
  for (;;) {
    if (isNever(scene, 7u)) break;
    const float inv_z = facetInvZ(loadFacet(scene.layers, layer, scene.extent, inside));
    reaches = reaches || (is_known && abs(inv_z - far_inv_z) <= stepAt(scene.deep, far_inv_z));
    ++layer;
    if (!is_known || reaches || layer == scene.layer_count) break;
  }
  return reaches;
}

#endif  // VIEWLOOM_LIB_WALK_WALK_EDGES_GLSL_
