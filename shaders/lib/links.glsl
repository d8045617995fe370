// SPDX-License-Identifier: Apache-2.0
// Which facets on the two sides of an edge are one surface (shaders/README.md, Links), for four
// edges at a time. The includer has kLayerCount.
#ifndef VIEWLOOM_LIB_LINKS_GLSL_
#define VIEWLOOM_LIB_LINKS_GLSL_

#include "lib/fault.glsl"
#include "lib/structure_access.glsl"

// One side of four edges, by layer.
struct EdgeSide {
  vec4 at[kLayerCountMax];          // inv_z at the middle of the edge; kNoSurface: no surface
  vec4 facet_high[kLayerCountMax];  // largest inv_z of the facet
};

// What links do to the facets on one side.
struct EdgeLinks {
  uvec4 link[kLayerCountMax];  // 0 = silhouette, 1 + layer of the other side, kDeepEdge
  vec4
      forward_high[kLayerCountMax];  // facet_high of what links from here or deeper lead forward to
};

const uint kNoLink = kLayerCountMax;

bvec4 both(bvec4 a, bvec4 b) {
  return mix(bvec4(false), a, b);
}

bvec4 mayLink(vec4 a, vec4 b, vec2 kappa) {
  const vec4 tolerance = max(vec4(kappa.x), kappa.y * max(a, b));
  return both(greaterThanEqual(min(a, b), vec4(0.0)), lessThanEqual(abs(a - b), tolerance));
}

// Which silhouettes `far` would be the far side of, if nothing is linked.
bvec4 isDeepBehind(vec4 far, vec4 near) {
  return both(greaterThanEqual(far, vec4(0.0)), greaterThan(near * (1.0 - kDeepStep), far));
}

// The layer nearest to each value among those of the other side not linked to their own layer.
uvec4 nearestFree(vec4 value, EdgeSide there, bvec4 taken[kLayerCountMax], uint own_layer,
                  vec2 kappa) {
  uvec4 nearest = uvec4(kNoLink);
  vec4 distance_min = vec4(3.4e38);
  for (uint i = 0u; i < kLayerCount; ++i) {
    if (i == own_layer) continue;
    const vec4 apart = abs(value - there.at[i]);
    const bvec4 is_nearer = both(both(not(taken[i]), lessThan(apart, distance_min)),
                                 mayLink(value, there.at[i], kappa));
    distance_min = mix(distance_min, apart, is_nearer);
    nearest = mix(nearest, uvec4(i), is_nearer);
  }
  return nearest;
}

// A link from layer `from` here to layer `to` there.
void addLink(inout EdgeLinks links, EdgeSide there, uint from, uint to, bvec4 is_linked) {
  links.link[from] = mix(links.link[from], uvec4(to + 1u), is_linked);
  // A walk of the layers in between must look at the edge: the surface goes on in front of them.
  for (uint i = 0u; i < kLayerCount; ++i) {
    const bvec4 is_before = both(is_linked, bvec4(i > to && i <= from));
    links.forward_high[i] =
        mix(links.forward_high[i], max(links.forward_high[i], there.facet_high[to]), is_before);
  }
}

// Links of layer `from` here to other layers there, where both want it. `wanted`: by the other
// side.
void linkToOthers(EdgeSide here, EdgeSide there, bvec4 taken[kLayerCountMax],
                  uvec4 wanted[kLayerCountMax], uint from, vec2 kappa, inout EdgeLinks links_here,
                  inout EdgeLinks links_there) {
  const uvec4 nearest = nearestFree(here.at[from], there, taken, from, kappa);
  for (uint to = 0u; to < kLayerCount; ++to) {
    if (to == from) continue;
    const bvec4 is_mutual = both(equal(nearest, uvec4(to)), equal(wanted[to], uvec4(from)));
    const bvec4 is_linked = both(is_mutual, both(not(taken[from]), not(taken[to])));
    addLink(links_here, there, from, to, is_linked);
    addLink(links_there, here, to, from, is_linked);
  }
}

// Calls for each layer stand one by one: loops of that size are not unrolled by all compilers, and
// arrays that are then indexed at run time cost many times more.
void linkAcross(EdgeSide here, EdgeSide there, vec2 kappa, out EdgeLinks links_here,
                out EdgeLinks links_there) {
  bvec4 taken[kLayerCountMax];  // linked to their own layer
  for (uint i = 0u; i < kLayerCount; ++i) {
    taken[i] = mayLink(here.at[i], there.at[i], kappa);
    const bvec4 deep_here = isDeepBehind(here.at[i], there.at[i]);
    const bvec4 deep_there = isDeepBehind(there.at[i], here.at[i]);
    links_here.link[i] =
        mix(mix(uvec4(0u), uvec4(kDeepEdge), deep_here), uvec4(i + 1u), taken[i]);
    links_there.link[i] =
        mix(mix(uvec4(0u), uvec4(kDeepEdge), deep_there), uvec4(i + 1u), taken[i]);
    links_here.forward_high[i] = vec4(kNoSurface);
    links_there.forward_high[i] = vec4(kNoSurface);
  }
  if (kLayerCount == 1u || hasFault(kFaultCrossLinks)) return;
  uvec4 wanted[kLayerCountMax];
  wanted[0] = nearestFree(there.at[0], here, taken, 0u, kappa);
  wanted[1] = nearestFree(there.at[1], here, taken, 1u, kappa);
  if (kLayerCount > 2u) wanted[2] = nearestFree(there.at[2], here, taken, 2u, kappa);
  if (kLayerCount > 3u) wanted[3] = nearestFree(there.at[3], here, taken, 3u, kappa);
  linkToOthers(here, there, taken, wanted, 0u, kappa, links_here, links_there);
  linkToOthers(here, there, taken, wanted, 1u, kappa, links_here, links_there);
  if (kLayerCount > 2u) {
    linkToOthers(here, there, taken, wanted, 2u, kappa, links_here, links_there);
  }
  if (kLayerCount > 3u) {
    linkToOthers(here, there, taken, wanted, 3u, kappa, links_here, links_there);
  }
}

#endif  // VIEWLOOM_LIB_LINKS_GLSL_
