// SPDX-License-Identifier: Apache-2.0
// Px that a silhouette covers in part (shaders/color.md, Edges): of two neighbours in a row of a
// view, the one in which the edge lies takes some of the other's colour.
#ifndef VIEWLOOM_LIB_LIGHT_EDGE_BLEND_GLSL_
#define VIEWLOOM_LIB_LIGHT_EDGE_BLEND_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/structure/structure_access.glsl"
#include "lib/walk/walk_edges.glsl"

// Colour of a pixel, and its place.
struct Seen {
  vec3 color;   // as texels have it
  float inv_z;  // of the hit; kNoSurface without one
  ivec2 cell;
  uint layer;
  vec2 at_sky;          // where its ray is at inv_z = 0, px
  vec2 px_per_inv_z;    // and how it moves from there
  float clean;          // as opaqueLight has it: how much the view differs from the source's own
};

vec2 placeAt(Seen seen, float inv_z) {
  return seen.at_sky + inv_z * seen.px_per_inv_z;
}

// How far the edge of the near px's surface lies from it towards the other px, 0..1; 2 if there is
// none between: what ends beside something nearer has no edge of its own, and one that is turned
// away is not seen.
float edgeBetween(Scene scene, Seen near, Seen other, bool is_sought) {
  const vec2 from = placeAt(near, near.inv_z);
  const vec2 way = placeAt(other, near.inv_z) - from;
  const bvec2 is_up = greaterThan(way, vec2(0.0));
  const ivec2 direction = mix(ivec2(-1), ivec2(1), is_up);
  const vec2 pace = 1.0 / max(abs(way), vec2(1e-20));
  ivec2 cell = near.cell;
  uint layer = near.layer;
  float apart = 2.0;
  uint column = 0u;
  for (;;) {
    if (isNever(scene, 7u)) break;
    const vec2 edges = vec2(cell) + vec2(is_up);
    const vec2 ahead = abs(edges - from) * pace;
    const bool cross_x = ahead.x <= ahead.y;
    const uint axis = cross_x ? kAxisX : kAxisY;
    const vec2 place = from + min(ahead.x, ahead.y) * way;
    const uint edge = edgeOfAxis(axis, direction, true);
    const uint link = linkOfEdge(loadLinks(scene.layers, layer, scene.extent, cell), edge);
    const ivec2 next = cell + stepOfAxis(axis, direction);
    const ivec2 beyond = clamp(next, ivec2(0), scene.extent.size_px - 1);
    // Both px as they see what lies as near as the surface at its edge.
    const float inv_z =
        facetAtPoint(loadFacet(scene.layers, layer, scene.extent, cell), cell, place);
    const float inv_z_beyond =
        facetAtPoint(loadFacet(scene.layers, layer, scene.extent, beyond), beyond, place);
    const vec2 own = placeAt(near, inv_z);
    const vec2 beside = placeAt(other, inv_z) - own;
    const vec2 shares = (edges - own) / mix(beside, vec2(1e-20), equal(beside, vec2(0.0)));
    const float share = cross_x ? shares.x : shares.y;
    const bool is_edge = link == 0u && beyond == next && inv_z_beyond < inv_z;
    const bool is_between = is_sought && share < 1.0;
    apart = is_between && is_edge && share >= 0.0 ? share : 2.0;
    cell = next;
    layer = link - 1u;
    ++column;
    if (!is_between || link == 0u || column == kEdgeColumnsMax) break;
  }
  return apart;
}

// Whether two neighbours are far enough apart for an edge: one thing is not linked to another that
// is nearer to it than this.
bool mayBeEdge(Scene scene, float a, float b) {
  const float kappa = stepAt(scene.kappa, max(a, b));
  return abs(a - b) > kEdgeStepKappas * kappa;
}

// `own_a`, `own_b`: colours before any blend.
void blendAcross(Scene scene, inout Seen a, inout Seen b, vec3 own_a, vec3 own_b) {
  const bool a_is_near = a.inv_z > b.inv_z;
  const bool is_sought = a.inv_z != b.inv_z;
  Seen near = a;
  Seen other = b;
  if (!a_is_near) {
    near = b;
    other = a;
  }
  const float apart = edgeBetween(scene, near, other, is_sought);
  const float near_loses = near.clean * max(0.5 - apart, 0.0);
  const float other_loses = apart <= 1.0 ? near.clean * max(apart - 0.5, 0.0) : 0.0;
  const float a_loses = a_is_near ? near_loses : other_loses;
  const float b_loses = a_is_near ? other_loses : near_loses;
  a.color = mix(a.color, own_b, a_loses);
  b.color = mix(b.color, own_a, b_loses);
}

#endif  // VIEWLOOM_LIB_LIGHT_EDGE_BLEND_GLSL_
