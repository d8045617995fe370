// SPDX-License-Identifier: Apache-2.0
// Cells and links of a layer of a structure.
#ifndef VIEWLOOM_LIB_STRUCTURE_STRUCTURE_ACCESS_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_STRUCTURE_ACCESS_GLSL_

#include "lib/structure/facet.glsl"
#include "lib/memory.glsl"

// Sides of the image, and of the arrays: rounded up to whole nodes of the last level.
struct Extent {
  ivec2 size_px;
  uint padded_width;
  uint padded_area;
  uint layer_words;
};

Extent makeExtent(ivec2 size_px) {
  const uint mask = (1u << kLevelLast) - 1u;
  const uvec2 padded = (uvec2(size_px) + mask) & ~mask;
  const uint area = padded.x * padded.y;
  return Extent(size_px, padded.x, area, layerWords(area));
}

uint facetIndex(Extent extent, ivec2 pixel) {
  return levelOffset(kLevelFacets, extent.padded_area) + uint(pixel.y) * extent.padded_width +
         uint(pixel.x);
}

// The word with the links of four px of a row, of which `pixel` is one.
uint linkWordIndex(Extent extent, ivec2 pixel) {
  return cellCount(extent.padded_area) + (uint(pixel.y) * extent.padded_width + uint(pixel.x)) / 4u;
}

// `cell` in units of the level's own cells.
uint cellIndex(Extent extent, uint level, uvec2 cell) {
  const uint shift = level == kLevelEntries ? kLevelFirst : level;
  return levelOffset(level, extent.padded_area) + cell.y * (extent.padded_width >> shift) + cell.x;
}

uvec2 loadWord(Address layers[kLayerCountMax], uint layer, Extent extent, uint index) {
  if (kReadByAddress) return Uvec2Ref(pickAddress(layers, layer)).at[index];
  return texelFetch(structure_texels, int(layer * extent.layer_words + index)).xy;
}

void storeWord(Address layers[kLayerCountMax], uint layer, Extent extent, uint index, uvec2 word) {
  if (kWriteByAddress)
    Uvec2Ref(pickAddress(layers, layer)).at[index] = word;
  else
    structure_out[layer * extent.layer_words + index] = word;
}

uvec2 loadFacet(Address layers[kLayerCountMax], uint layer, Extent extent, ivec2 pixel) {
  return loadWord(layers, layer, extent, facetIndex(extent, pixel));
}

uvec2 loadCell(Address layers[kLayerCountMax], uint layer, Extent extent, uint level, uvec2 cell) {
  return loadWord(layers, layer, extent, cellIndex(extent, level, cell));
}

void storeCell(Address layers[kLayerCountMax], uint layer, Extent extent, uint level, uvec2 cell,
               uvec2 bits) {
  storeWord(layers, layer, extent, cellIndex(extent, level, cell), bits);
}

// kNoSurface where there is none.
float facetInvZ(uvec2 facet) {
  return facet.x == kNoFacet ? kNoSurface : uintBitsToFloat(facet.x & ~kForwardLinkFlag);
}

// The facet's surface at an image point; kNoSurface where there is none.
float facetAtPoint(uvec2 facet, ivec2 pixel, vec2 point) {
  const float inv_z = facetInvZ(facet);
  return inv_z < 0.0 ? kNoSurface
                     : facetAt(inv_z, unpackSlopes(facet.y), point - vec2(pixel) - 0.5);
}

// The links of a facet in the low 16 bits, whatever is above them.
uint loadLinks(Address layers[kLayerCountMax], uint layer, Extent extent, ivec2 pixel) {
  const uint place = uint(pixel.y) * extent.padded_width + uint(pixel.x);
  const uint index = 2u * cellCount(extent.padded_area) + place / 2u;
  const uint two =
      kReadByAddress
          ? UintRef(pickAddress(layers, layer)).at[index]
          : texelFetch(structure_halves, int(2u * layer * extent.layer_words + index)).x;
  return two >> (16u * (place & 1u));
}

// The link of an edge: 0 = silhouette, 1 + k = linked to layer k of the neighbouring column.
uint linkOfEdge(uint links, uint edge) {
  const uint link = (links >> (edge * kLinkBits)) & 7u;
  return link >= kKnownBehind ? 0u : link;
}

// Whether the facet is the far side of a deep silhouette there.
bool isDeepEdge(uint links, uint edge) {
  return ((links >> (edge * kLinkBits)) & 7u) == kDeepEdge;
}

// Whether the facet is the far side of a deep silhouette at any of its edges: its colour may be
// mixed.
bool isMixed(uint links) {
  const uint kFirstBits = 0x249u;  // of all four edges
  return (links & (links >> 1) & (links >> 2) & kFirstBits) != 0u;
}

// Whether the facet is the near side of a silhouette there, with the far side known behind it.
bool isKnownBehind(uint links, uint edge) {
  return ((links >> (edge * kLinkBits)) & 7u) == kKnownBehind;
}

// A silhouette made a link.
uint withLink(uint links, uint edge, uint link) {
  return (links & ~(7u << (edge * kLinkBits))) | (link << (edge * kLinkBits));
}

// Steps between two surfaces, 1/m (shaders/structure.md, Steps): x = the least, y = share of the
// nearer one's distance from z. Every operation is rounded alone, as the sweep does it.
float stepAt(vec3 steps, float nearer_inv_z) {
  return max(steps.x, steps.y * (nearer_inv_z - steps.z));
}

// Largest step between two facets that are one surface.
vec3 connectedSteps(MeasuredHead measured) {
  return vec3(measured.kappa_abs, measured.kappa_rel, measured.inv_z_base);
}

// Beyond such a step stands another thing.
vec3 deepSteps(MeasuredHead measured) {
  return vec3(measured.deep_abs, kDeepStep, measured.inv_z_base);
}

#endif  // VIEWLOOM_LIB_STRUCTURE_STRUCTURE_ACCESS_GLSL_
