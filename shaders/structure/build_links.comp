// SPDX-License-Identifier: Apache-2.0
// Which facets of neighbouring columns are one surface (shaders/README.md, Links).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(constant_id = kOwnConstants) const uint kLayerCount = 2u;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

const uint kNoLayer = kLayerCountMax;

struct Column {
  float inv_z[kLayerCountMax];
  vec2 slope[kLayerCountMax];
};

// inv_z at the middle of an edge; kNoSurface where there is no surface.
struct EdgeValues {
  float at[kLayerCountMax];
};

Column loadColumn(Extent extent, ivec2 pixel) {
  const bool exists = isInside(extent, pixel);
  const ivec2 inside = clamp(pixel, ivec2(0), extent.size_px - 1);
  Column column;
  for (uint i = 0u; i < kLayerCount; ++i) {
    const uvec2 facet = loadFacet(push.layers, i, extent, inside);
    column.inv_z[i] = exists ? facetInvZ(facet) : kNoSurface;
    column.slope[i] = unpackSlopes(facet.y);
  }
  return column;
}

EdgeValues edgeValues(Column column, vec2 to_edge) {
  EdgeValues values;
  for (uint i = 0u; i < kLayerCount; ++i) {
    const float at_edge = facetAt(column.inv_z[i], column.slope[i], to_edge);
    values.at[i] = column.inv_z[i] < 0.0 ? kNoSurface : at_edge;
  }
  return values;
}

bool mayLink(float a, float b, float kappa_abs, float kappa_rel) {
  return a >= 0.0 && b >= 0.0 && abs(a - b) <= connectionTolerance(kappa_abs, kappa_rel, max(a, b));
}

// The layer nearest to a value among those not taken by their own layer.
uint nearestFree(float value, EdgeValues there, uint taken, uint own_layer, float kappa_abs,
                 float kappa_rel) {
  uint nearest = kNoLayer;
  float distance_min = 3.4e38;
  for (uint i = 0u; i < kLayerCount; ++i) {
    const bool is_free = i != own_layer && ((taken >> i) & 1u) == 0u;
    const float apart = abs(value - there.at[i]);
    if (is_free && apart < distance_min && mayLink(value, there.at[i], kappa_abs, kappa_rel)) {
      distance_min = apart;
      nearest = i;
    }
  }
  return nearest;
}

// Adds the links of all layers across one edge to the link words. Bit k of `forward`: a link leads
// from layer k or a deeper one to one before layer k.
void linkAcross(EdgeValues here, EdgeValues there, uint edge, float kappa_abs, float kappa_rel,
                inout uint words[kLayerCountMax], inout uint forward) {
  uint taken = 0u;  // layers linked to themselves
  for (uint i = 0u; i < kLayerCount; ++i) {
    const bool linked = mayLink(here.at[i], there.at[i], kappa_abs, kappa_rel);
    taken |= linked ? 1u << i : 0u;
    words[i] |= linked ? (i + 1u) << (edge * kLinkBits) : 0u;
  }
  if (kLayerCount == 1u || hasFault(kFaultCrossLinks)) return;
  for (uint i = 0u; i < kLayerCount; ++i) {
    if (here.at[i] < 0.0 || ((taken >> i) & 1u) != 0u) continue;
    const uint other = nearestFree(here.at[i], there, taken, i, kappa_abs, kappa_rel);
    for (uint j = 0u; j < kLayerCount; ++j) {
      if (j != other || nearestFree(there.at[j], here, taken, j, kappa_abs, kappa_rel) != i)
        continue;
      words[i] |= (j + 1u) << (edge * kLinkBits);
      // Layers j + 1 .. i.
      forward |= j < i ? (2u << i) - (2u << j) : 0u;
    }
  }
}

void main() {
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (!isInside(extent, pixel)) return;
  const float kappa_abs = measured_head.kappa_abs;
  const float kappa_rel = measured_head.kappa_rel;

  uint words[kLayerCountMax];
  for (uint i = 0u; i < kLayerCount; ++i) words[i] = 0u;
  uint forward = 0u;
  const Column here = loadColumn(extent, pixel);
  const ivec2 steps[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
  for (uint edge = 0u; edge < 4u; ++edge) {
    const vec2 to_edge = 0.5 * vec2(steps[edge]);
    const Column there = loadColumn(extent, pixel + steps[edge]);
    linkAcross(edgeValues(here, to_edge), edgeValues(there, -to_edge), edge, kappa_abs, kappa_rel,
               words, forward);
  }
  for (uint i = 0u; i < kLayerCount; ++i) {
    storeLinks(push.layers, i, extent, pixel, words[i] | (here.inv_z[i] < 0.0 ? 0u : kFacetExists));
    if (((forward >> i) & 1u) != 0u) {
      const uint flagged = floatBitsToUint(here.inv_z[i]) | kForwardLinkFlag;
      storeWord(push.layers, i, extent, facetIndex(extent, pixel),
                uvec2(flagged, packSlopes(here.slope[i])));
    }
  }
}
