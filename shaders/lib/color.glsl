// SPDX-License-Identifier: Apache-2.0
// Colour: sRGB transfer, and the colour of a surface point, interpolated within its connected surface.
#ifndef VIEWLOOM_LIB_COLOR_GLSL_
#define VIEWLOOM_LIB_COLOR_GLSL_

#include "lib/facet.glsl"
#include "lib/structure_access.glsl"

// Minimax fits of the sRGB curve (IEC 61966-2-1) beyond its straight toe: within 0.06 of 1/255 when
// decoding, 0.09 when encoding (over sqrt(light)), so 8-bit colour survives both unchanged.
vec3 linearFromSrgb(vec3 srgb) {
  const vec3 curve =
      (((-0.1167994 * srgb + 0.5265083) * srgb + 0.5603838) * srgb + 0.02840018) * srgb + 0.001046527;
  return mix(curve, srgb * (1.0 / 12.92), lessThanEqual(srgb, vec3(0.04045)));
}

vec3 srgbFromLinear(vec3 light) {
  const vec3 clipped = clamp(light, 0.0, 1.0);
  const vec3 root = sqrt(clipped);
  const vec3 curve =
      ((((0.5169230 * root - 1.6225148) * root + 2.0303334) * root - 1.4021480) * root + 1.5178347) * root -
      0.04010249;
  return mix(curve, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
}

// Premultiplied linear BT.709.
vec4 loadTexel(StructureRef structure, uint layer, uint color_format, ivec2 texel) {
  const ColorPlane plane = structure.value.color[layer];
  const uint index = uint(texel.y) * plane.width_px + uint(texel.x);
  if (color_format == kColorRgba8) {
    return vec4(linearFromSrgb(unpackUnorm4x8(UintRef(plane.texels).at[index]).rgb), 1.0);
  }
  const uvec2 bits = Uvec2Ref(plane.texels).at[index];
  return vec4(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y));
}

// Where the neighbour of a facet in one direction goes on: 1 + its layer, or 0 for a silhouette.
uint linkTowards(StructureRef structure, uint layer, ivec2 cell, ivec2 along) {
  const uint edge = along.x != 0 ? (along.x > 0 ? kEdgeRight : kEdgeLeft)
                                 : (along.y > 0 ? kEdgeBottom : kEdgeTop);
  return linkOfEdge(loadLinks(structure, layer, cell), edge);
}

// Sub-texel positions have 1/256 px, as in texture units: a ray through a sample's centre returns the
// sample, whatever the last bits of its position.
const float kSubtexelSteps = 256.0;

// Colour planes of the depth's size: one texel a facet. Bilinear over the up to four facets around the
// point that are linked; what lies across a silhouette takes no part.
vec4 surfaceColorPerFacet(StructureRef structure, uint color_format, uint layer, ivec2 cell, vec2 point) {
  const vec2 offset = round((point - vec2(cell) - 0.5) * kSubtexelSteps) / kSubtexelSteps;
  const vec2 share = min(abs(offset), vec2(0.5));
  const ivec2 toward = ivec2(offset.x >= 0.0 ? 1 : -1, offset.y >= 0.0 ? 1 : -1);
  const ivec2 along_x = ivec2(toward.x, 0);
  const ivec2 along_y = ivec2(0, toward.y);
  const uint links = loadLinks(structure, layer, cell);
  const uint link_x = linkOfEdge(links, toward.x > 0 ? kEdgeRight : kEdgeLeft);
  const uint link_y = linkOfEdge(links, toward.y > 0 ? kEdgeBottom : kEdgeTop);
  uint link_xy = 0u;
  if (link_x > 0u) link_xy = linkTowards(structure, link_x - 1u, cell + along_x, along_y);
  else if (link_y > 0u) link_xy = linkTowards(structure, link_y - 1u, cell + along_y, along_x);

  float weight = (1.0 - share.x) * (1.0 - share.y);
  vec4 sum = weight * loadTexel(structure, layer, color_format, cell);
  if (link_x > 0u && share.x > 0.0) {
    const float here = share.x * (1.0 - share.y);
    sum += here * loadTexel(structure, link_x - 1u, color_format, cell + along_x);
    weight += here;
  }
  if (link_y > 0u && share.y > 0.0) {
    const float here = (1.0 - share.x) * share.y;
    sum += here * loadTexel(structure, link_y - 1u, color_format, cell + along_y);
    weight += here;
  }
  if (link_xy > 0u && share.x > 0.0 && share.y > 0.0) {
    const float here = share.x * share.y;
    sum += here * loadTexel(structure, link_xy - 1u, color_format, cell + along_x + along_y);
    weight += here;
  }
  return sum / weight;
}

// The layer of a column that continues a facet there: the surface nearest to the facet's plane, if it is
// within the connection tolerance for every px between. kLayerCountMax: none.
uint continuingLayer(StructureRef structure, uint layer, ivec2 cell, ivec2 column, float kappa_abs,
                     float kappa_rel) {
  if (column == cell) return layer;
  const uvec2 facet = loadFacet(structure, layer, cell);
  const vec2 apart = vec2(column - cell);
  const float expected = facetAt(uintBitsToFloat(facet.x), unpackSlopes(facet.y), apart);
  const float tolerance =
      connectionTolerance(kappa_abs, kappa_rel, expected) * max(abs(apart.x) + abs(apart.y), 1.0);
  uint nearest = kLayerCountMax;
  float distance_min = tolerance;
  for (uint other = 0u; other < structure.value.layer_count; ++other) {
    const float inv_z = loadInvZ(structure, other, column);
    if (inv_z < 0.0 || abs(inv_z - expected) > distance_min) continue;
    distance_min = abs(inv_z - expected);
    nearest = other;
  }
  return nearest;
}

// Colour planes of another size, looked up by uv: bilinear over the texels whose facet continues the
// hit's.
vec4 surfaceColorScaled(StructureRef structure, uint color_format, uint layer, ivec2 cell, vec2 point,
                        float kappa_abs, float kappa_rel) {
  const ivec2 size = ivec2(structure.value.width_px, structure.value.height_px);
  const ColorPlane plane = structure.value.color[layer];
  const vec2 scale = vec2(plane.width_px, plane.height_px) / vec2(size);
  const vec2 position = round((point * scale - 0.5) * kSubtexelSteps) / kSubtexelSteps;
  const vec2 share = position - floor(position);
  vec4 sum = vec4(0.0);
  float weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    const ivec2 corner = ivec2(i & 1, i >> 1);
    const ivec2 unclamped = ivec2(floor(position)) + corner;
    const vec2 shares = mix(1.0 - share, share, equal(corner, ivec2(1)));
    const ivec2 texel = clamp(unclamped, ivec2(0), ivec2(plane.width_px, plane.height_px) - 1);
    const ivec2 column = clamp(ivec2(floor((vec2(texel) + 0.5) / scale)), ivec2(0), size - 1);
    const uint other = continuingLayer(structure, layer, cell, column, kappa_abs, kappa_rel);
    if (other == kLayerCountMax) continue;
    sum += shares.x * shares.y * loadTexel(structure, other, color_format, texel);
    weight += shares.x * shares.y;
  }
  if (weight > 0.0) return sum / weight;
  const ivec2 own = clamp(ivec2((vec2(cell) + 0.5) * scale), ivec2(0), ivec2(plane.width_px, plane.height_px) - 1);
  return loadTexel(structure, layer, color_format, own);
}

#endif  // VIEWLOOM_LIB_COLOR_GLSL_
