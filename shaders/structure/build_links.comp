// SPDX-License-Identifier: Apache-2.0
// Which facets of neighbouring columns are one surface (shaders/README.md, Links).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/facet.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

struct EdgeValues {
  float at[kLayerCountMax];  // inv_z at the middle of an edge, kNoSurface where there is no surface
};

EdgeValues edgeValues(StructureRef structure, ivec2 pixel, vec2 to_edge) {
  EdgeValues values;
  for (uint layer = 0u; layer < structure.value.layer_count; ++layer) {
    const uvec2 facet = loadFacet(structure, layer, pixel);
    const float inv_z = uintBitsToFloat(facet.x);
    values.at[layer] = inv_z < 0.0 ? kNoSurface : facetAt(inv_z, unpackSlopes(facet.y), to_edge);
  }
  return values;
}

bool mayLink(float a, float b, float kappa_abs, float kappa_rel) {
  return a >= 0.0 && b >= 0.0 && abs(a - b) <= connectionTolerance(kappa_abs, kappa_rel, max(a, b));
}

// The layer of `there` that a value links to among those not taken by their own layer; kLayerCountMax =
// none.
uint nearestFree(float value, EdgeValues there, uint taken, uint own_layer, uint layer_count,
                 float kappa_abs, float kappa_rel) {
  uint nearest = kLayerCountMax;
  float distance_min = 3.4e38;
  for (uint layer = 0u; layer < layer_count; ++layer) {
    if (layer == own_layer || ((taken >> layer) & 1u) != 0u) continue;
    if (!mayLink(value, there.at[layer], kappa_abs, kappa_rel)) continue;
    const float apart = abs(value - there.at[layer]);
    if (apart < distance_min) {
      distance_min = apart;
      nearest = layer;
    }
  }
  return nearest;
}

// Link words of all layers across one edge: word[k] gets its 3 bits.
void linkAcross(EdgeValues here, EdgeValues there, uint edge, uint layer_count, float kappa_abs,
                float kappa_rel, inout uint words[kLayerCountMax]) {
  uint taken = 0u;  // layers linked to themselves
  for (uint layer = 0u; layer < layer_count; ++layer) {
    if (!mayLink(here.at[layer], there.at[layer], kappa_abs, kappa_rel)) continue;
    taken |= 1u << layer;
    words[layer] |= (layer + 1u) << (edge * kLinkBits);
  }
  for (uint layer = 0u; layer < layer_count; ++layer) {
    if (here.at[layer] < 0.0 || ((taken >> layer) & 1u) != 0u) continue;
    const uint other =
        nearestFree(here.at[layer], there, taken, layer, layer_count, kappa_abs, kappa_rel);
    if (other == kLayerCountMax) continue;
    const uint back =
        nearestFree(there.at[other], here, taken, other, layer_count, kappa_abs, kappa_rel);
    if (back == layer) words[layer] |= (other + 1u) << (edge * kLinkBits);
  }
}

void main() {
  StructureRef structure = StructureRef(push.structure);
  MeasuredRef measured = MeasuredRef(structure.value.measured);
  const ivec2 size = ivec2(structure.value.width_px, structure.value.height_px);
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  const uint layer_count = structure.value.layer_count;
  const float kappa_abs = measured.value.kappa_abs;
  const float kappa_rel = measured.value.kappa_rel;

  uint words[kLayerCountMax] = uint[kLayerCountMax](0u, 0u, 0u, 0u);
  const ivec2 steps[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
  for (uint edge = 0u; edge < 4u; ++edge) {
    const ivec2 neighbor = pixel + steps[edge];
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThanEqual(neighbor, size))) continue;
    const vec2 to_edge = 0.5 * vec2(steps[edge]);
    linkAcross(edgeValues(structure, pixel, to_edge), edgeValues(structure, neighbor, -to_edge), edge,
               layer_count, kappa_abs, kappa_rel, words);
  }
  const uint index = pixelIndex(structure, pixel);
  for (uint layer = 0u; layer < layer_count; ++layer) {
    Uint16Ref(structure.value.links[layer]).at[index] = uint16_t(words[layer]);
  }
}
