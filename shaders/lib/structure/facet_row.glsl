// SPDX-License-Identifier: Apache-2.0
// Facets of all layers, four px of a row at a time.
#ifndef VIEWLOOM_LIB_STRUCTURE_FACET_ROW_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_FACET_ROW_GLSL_

#include "lib/structure/layer_count.glsl"
#include "lib/structure/links.glsl"
#include "lib/structure/structure_access.glsl"

// Four facets of a layer side by side.
struct Facets {
  vec4 inv_z;
  vec4 slope_x;
  vec4 slope_y;
};

struct FacetRow {
  Facets layer[kLayerCountMax];
};

// Where nothing `exists`, memory may hold anything, also what is no number.
void loadInto(inout Facets facets, int k, Address layers[kLayerCountMax], Extent extent, uint layer,
              ivec2 pixel, bool exists) {
  const uvec2 stored = loadFacet(layers, layer, extent, pixel);
  const uvec2 facet = mix(uvec2(kNoFacet, 0u), stored, bvec2(exists));
  const vec2 slope = unpackSlopes(facet.y);
  facets.inv_z[k] = facetInvZ(facet);
  facets.slope_x[k] = slope.x;
  facets.slope_y[k] = slope.y;
}

FacetRow loadRow(Address layers[kLayerCountMax], Extent extent, ivec2 pixel, bool exists) {
  FacetRow row;
  for (uint i = 0u; i < kLayerCount; ++i) {
    for (int k = 0; k < 4; ++k) {
      loadInto(row.layer[i], k, layers, extent, i, pixel + ivec2(k, 0), exists);
    }
  }
  return row;
}

// One facet of each layer in the first component, and no surface beside it.
FacetRow loadOne(Address layers[kLayerCountMax], Extent extent, ivec2 pixel, bool exists) {
  FacetRow one;
  for (uint i = 0u; i < kLayerCount; ++i) {
    one.layer[i] = Facets(vec4(kNoSurface), vec4(0.0), vec4(0.0));
    loadInto(one.layer[i], 0, layers, extent, i, pixel, exists);
  }
  return one;
}

// Bounds of a facet over its footprint have three roundings, each of at most half an ulp of the
// largest value: outward by one to two ulp of that.
const float kFacetBoxMargin = 1.1920928955078125e-7;

// The largest inv_z of each facet; no surface: kNoSurface.
vec4 highOf(Facets facets) {
  precise const vec4 half_range = 0.5 * (abs(facets.slope_x) + abs(facets.slope_y));
  precise const vec4 margin = (facets.inv_z + half_range) * kFacetBoxMargin;
  precise const vec4 high = (facets.inv_z + half_range) + margin;
  return mix(high, vec4(kNoSurface), lessThan(facets.inv_z, vec4(0.0)));
}

// The least inv_z of each; meaningless where there is no surface.
vec4 lowOf(Facets facets) {
  precise const vec4 half_range = 0.5 * (abs(facets.slope_x) + abs(facets.slope_y));
  precise const vec4 margin = (facets.inv_z + half_range) * kFacetBoxMargin;
  precise const vec4 low = (facets.inv_z - half_range) - margin;
  return max(low, vec4(0.0));
}

// The side of the edges half a px along x or y from the samples.
EdgeSide sideOf(FacetRow row, vec2 to_edge) {
  EdgeSide side;
  for (uint i = 0u; i < kLayerCount; ++i) {
    const Facets facets = row.layer[i];
    const vec4 at_edge =
        max(facets.inv_z + (to_edge.x * facets.slope_x + to_edge.y * facets.slope_y), vec4(0.0));
    side.at[i] = mix(at_edge, vec4(kNoSurface), lessThan(facets.inv_z, vec4(0.0)));
    side.facet_high[i] = highOf(facets);
  }
  return side;
}

#endif  // VIEWLOOM_LIB_STRUCTURE_FACET_ROW_GLSL_
