// SPDX-License-Identifier: Apache-2.0
// Which facets on the two sides of an edge are one surface (shaders/structure.md, Links), for four
// edges at a time.
#ifndef VIEWLOOM_LIB_STRUCTURE_LINKS_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_LINKS_GLSL_

#include "lib/fault.glsl"
#include "lib/structure/layer_count.glsl"
#include "lib/structure/structure_access.glsl"

// One side of four edges, by layer.
struct EdgeSide {
  vec4 at[kLayerCountMax];          // inv_z at the middle of the edge; kNoSurface: no surface
  vec4 facet_high[kLayerCountMax];  // largest inv_z of the facet
};

// Effect of links on the facets on one side.
struct EdgeLinks {
  uvec4 link[kLayerCountMax];  // 0 = silhouette, 1 + layer of the other side, or kind of silhouette
  vec4
      forward_high[kLayerCountMax];  // facet_high of what links from here or deeper lead forward to
};

// Largest step within a surface, and from where on there are two things (stepAt).
struct Steps {
  vec3 kappa;
  vec3 deep;
};

const uint kNoLink = kLayerCountMax;

bvec4 both(bvec4 a, bvec4 b) {
  return mix(bvec4(false), a, b);
}

vec4 stepAt(vec3 steps, vec4 nearer) {
  return max(vec4(steps.x), steps.y * (nearer - steps.z));
}

bvec4 mayLink(vec4 a, vec4 b, vec3 kappa) {
  const vec4 tolerance = stepAt(kappa, max(a, b));
  return both(greaterThanEqual(min(a, b), vec4(0.0)), lessThanEqual(abs(a - b), tolerance));
}

// Which silhouettes `far` would be the far side of, if nothing is linked.
bvec4 isDeepBehind(vec4 far, vec4 near, vec3 deep) {
  return both(greaterThanEqual(far, vec4(0.0)), greaterThan(near - stepAt(deep, near), far));
}

// Which silhouettes have their far side, `there`, known behind the near one, which is here: as far
// back as that, or further, is `furthest` of the deeper layers here.
bvec4 isKnownBehind(vec4 here, vec4 there, vec4 furthest, vec3 kappa) {
  const vec4 tolerance = stepAt(kappa, max(furthest, there));
  const bvec4 is_near = both(greaterThanEqual(there, vec4(0.0)), greaterThan(here, there));
  return both(is_near, lessThanEqual(furthest - there, tolerance));
}

// Name of a layer's edge without a link: 0, or a kind of silhouette.
uvec4 silhouetteOf(vec4 here, vec4 there, vec4 furthest, Steps steps) {
  const uvec4 far = mix(uvec4(0u), uvec4(kDeepEdge), isDeepBehind(here, there, steps.deep));
  return mix(far, uvec4(kKnownBehind), isKnownBehind(here, there, furthest, steps.kappa));
}

// The furthest of two layers at an edge; what is not there is nearer than anything.
vec4 furthestOf(vec4 one, vec4 other) {
  return mix(one, min(one, other), greaterThanEqual(other, vec4(0.0)));
}

// The layer nearest to each value among those of the other side not linked to their own layer.
uvec4 nearestFree(vec4 value, EdgeSide there, bvec4 taken[kLayerCountMax], uint own_layer,
                  vec3 kappa) {
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
                  uvec4 wanted[kLayerCountMax], uint from, vec3 kappa, inout EdgeLinks links_here,
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

// Links of a layer to itself, and what its silhouettes are. `furthest`: of the deeper layers.
void linkWithin(EdgeSide here, EdgeSide there, uint layer, Steps steps,
                inout bvec4 taken[kLayerCountMax], inout EdgeLinks links_here,
                inout EdgeLinks links_there, inout vec4 furthest_here, inout vec4 furthest_there) {
  const vec4 a = here.at[layer];
  const vec4 b = there.at[layer];
  const uvec4 own = uvec4(layer + 1u);
  taken[layer] = mayLink(a, b, steps.kappa);
  links_here.link[layer] = mix(silhouetteOf(a, b, furthest_here, steps), own, taken[layer]);
  links_there.link[layer] = mix(silhouetteOf(b, a, furthest_there, steps), own, taken[layer]);
  links_here.forward_high[layer] = vec4(kNoSurface);
  links_there.forward_high[layer] = vec4(kNoSurface);
  furthest_here = furthestOf(furthest_here, a);
  furthest_there = furthestOf(furthest_there, b);
}

// Calls for each layer stand one by one: loops of that size are not unrolled by all compilers, and
// arrays that are then indexed at run time cost many times more.
void linkAcross(EdgeSide here, EdgeSide there, Steps steps, out EdgeLinks links_here,
                out EdgeLinks links_there) {
  bvec4 taken[kLayerCountMax];  // linked to their own layer
  const vec4 nothing = vec4(3.4e38);
  vec4 furthest_here = nothing;
  vec4 furthest_there = nothing;
  if (kLayerCount > 3u) {
    linkWithin(here, there, 3u, steps, taken, links_here, links_there, furthest_here,
               furthest_there);
  }
  if (kLayerCount > 2u) {
    linkWithin(here, there, 2u, steps, taken, links_here, links_there, furthest_here,
               furthest_there);
  }
  if (kLayerCount > 1u) {
    linkWithin(here, there, 1u, steps, taken, links_here, links_there, furthest_here,
               furthest_there);
  }
  linkWithin(here, there, 0u, steps, taken, links_here, links_there, furthest_here,
             furthest_there);
  if (kLayerCount == 1u || hasFault(kFaultCrossLinks)) return;
  const vec3 kappa = steps.kappa;
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

#endif  // VIEWLOOM_LIB_STRUCTURE_LINKS_GLSL_
