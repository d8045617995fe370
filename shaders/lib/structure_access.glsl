// SPDX-License-Identifier: Apache-2.0
// Loads from a structure. Every buffer is reached by its address, so none is bound by the descriptor limit.
#ifndef VIEWLOOM_LIB_STRUCTURE_ACCESS_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_ACCESS_GLSL_

#include "shared/structure_abi.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer StructureRef { Structure value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MeasuredRef { Measured value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatRef { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UintRef { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Uvec2Ref { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 2) buffer Uint16Ref { uint16_t at[]; };

uint pixelIndex(StructureRef structure, ivec2 pixel) {
  return uint(pixel.y) * structure.value.width_px + uint(pixel.x);
}

// kNoSurface where the column has no such layer.
float loadInvZ(StructureRef structure, uint layer, ivec2 pixel) {
  return FloatRef(structure.value.inv_z[layer]).at[pixelIndex(structure, pixel)];
}

uvec2 loadFacet(StructureRef structure, uint layer, ivec2 pixel) {
  return Uvec2Ref(structure.value.facets[layer]).at[pixelIndex(structure, pixel)];
}

// The link of an edge: 0 = silhouette, 1 + k = linked to layer k of the neighbouring column.
uint linkOfEdge(uint links, uint edge) {
  return (links >> (edge * kLinkBits)) & 7u;
}

uint loadLinks(StructureRef structure, uint layer, ivec2 pixel) {
  return uint(Uint16Ref(structure.value.links[layer]).at[pixelIndex(structure, pixel)]);
}

uint nodeIndex(StructureRef structure, uint level, uvec2 cell) {
  const uint i = level - kLevelFirst;
  return structure.value.level_offset[i] + cell.y * structure.value.level_width[i] + cell.x;
}

uvec2 loadNode(StructureRef structure, uint layer, uint level, uvec2 cell) {
  return Uvec2Ref(structure.value.nodes[layer]).at[nodeIndex(structure, level, cell)];
}

uvec2 loadEntry(StructureRef structure, uint layer, uvec2 cell) {
  const uint index = cell.y * structure.value.level_width[0] + cell.x;
  return Uvec2Ref(structure.value.entries[layer]).at[index];
}

// Largest step between two facets that are one surface, 1/m.
float connectionTolerance(float kappa_abs, float kappa_rel, float nearer_inv_z) {
  return max(kappa_abs, kappa_rel * nearer_inv_z);
}

#endif  // VIEWLOOM_LIB_STRUCTURE_ACCESS_GLSL_
