// SPDX-License-Identifier: Apache-2.0
// The colour of a surface point in planes of another size than depth, looked up by uv.
#ifndef VIEWLOOM_LIB_LIGHT_SCALED_COLOR_GLSL_
#define VIEWLOOM_LIB_LIGHT_SCALED_COLOR_GLSL_

#include "lib/light/color.glsl"

// The layer of a column that continues a facet there: the surface nearest to the facet's plane, if
// it is within the connection tolerance for every px between. kLayerCountMax: none.
uint continuingLayer(Address layers[kLayerCountMax], uint layer_count, Extent extent, uint layer,
                     ivec2 cell, ivec2 column, vec3 kappa) {
  if (column == cell) return layer;
  const vec2 apart = vec2(column - cell);
  const uvec2 facet = loadFacet(layers, layer, extent, cell);
  const float expected = facetAt(facetInvZ(facet), unpackSlopes(facet.y), apart);
  float distance_min =
      stepAt(kappa, expected) * max(abs(apart.x) + abs(apart.y), 1.0);
  uint nearest = kLayerCountMax;
  for (uint i = 0u; i < layer_count; ++i) {
    const float inv_z = facetInvZ(loadFacet(layers, i, extent, column));
    if (inv_z < 0.0 || abs(inv_z - expected) > distance_min) continue;
    distance_min = abs(inv_z - expected);
    nearest = i;
  }
  return nearest;
}

// The texel of a layer at a uv position.
vec4 texelAtUv(Address color[kLayerCountMax], ColorSizes sizes, uint color_format, uint layer,
               vec2 uv) {
  const ivec2 size_px = colorSize(sizes, layer);
  const ivec2 texel = clamp(ivec2(uv * vec2(size_px)), ivec2(0), size_px - 1);
  return loadTexel(color, layer, sizes.stride, color_format, uint(texel.y * size_px.x + texel.x));
}

// A place on a surface, the facet there, and its links.
struct SurfacePlace {
  vec2 point;
  ivec2 cell;
  uint layer;
  uint links;
};

// Part of a column that a covering texel may lack, px: roundings of uv are less.
const float kCoverRounding_px = 1.0 / kSubtexelSteps;

// How far beyond a deep silhouette, on its far side, colour may be the near thing's, px: as depth
// is that of the middles of px, the thing ends anywhere between two of them.
const float kMixedReach_px = 0.5;

// Off the far side of a deep silhouette, to where the next texel is free of it, by so much of the
// way as `clean` says; not where the surface is no two px wide. `low_edge`: of the two along the
// axis.
void moveFurtherIn(Address layers[kLayerCountMax], Extent extent, uint low_edge, float px_per_texel,
                   float clean, inout SurfacePlace place) {
  const bool deep_low = isDeepEdge(place.links, low_edge);
  const bool deep_high = isDeepEdge(place.links, low_edge + 1u);
  if (deep_low == deep_high) return;
  const int axis = low_edge == kEdgeLeft ? 0 : 1;
  const float own_px = place.point[axis] - float(place.cell[axis]);
  const float beyond_px = deep_low ? own_px : 1.0 - own_px;
  const float further_px = max(beyond_px, kMixedReach_px + 0.5 * px_per_texel);
  const float moved_px = mix(beyond_px, further_px, clean);
  SurfacePlace moved = place;
  moved.point[axis] = float(place.cell[axis]) + (deep_low ? moved_px : 1.0 - moved_px);
  if (moved_px >= 1.0) {
    const uint inner_edge = deep_low ? low_edge + 1u : low_edge;
    const uint link = linkOfEdge(place.links, inner_edge);
    if (link == 0u) return;
    moved.cell[axis] += deep_low ? 1 : -1;
    moved.layer = link - 1u;
    moved.links = loadLinks(layers, moved.layer, extent, moved.cell);
    if (isDeepEdge(moved.links, inner_edge)) return;
  }
  place = moved;
}

// Whether what is seen between two places of a column may be mixed.
bool isMixedBetween(uint links, vec2 low, vec2 high) {
  const bvec4 is_deep = bvec4(isDeepEdge(links, kEdgeLeft), isDeepEdge(links, kEdgeTop),
                              isDeepEdge(links, kEdgeRight), isDeepEdge(links, kEdgeBottom));
  const float reach = kMixedReach_px - kCoverRounding_px;
  const bvec4 is_near = bvec4(lessThan(low, vec2(reach)), greaterThan(high, vec2(1.0 - reach)));
  return any(mix(bvec4(false), is_deep, is_near));
}

// Part of a facet's surface within a texel.
struct TexelCover {
  uint layer;     // that continues it, where the texel is next to the facet; kLayerCountMax: none
  bool is_of_it;  // holds nothing else, not even what a silhouette may have mixed with it
};

// `low`, `high`: of the texel, px; the columns at its corners are looked at.
TexelCover coverOf(Address layers[kLayerCountMax], uint layer_count, Extent extent,
                   SurfacePlace place, vec2 low, vec2 high, vec3 kappa) {
  const ivec2 first = ivec2(low + kCoverRounding_px);
  const ivec2 last = max(first, ivec2(ceil(high - kCoverRounding_px)) - 1);
  TexelCover cover = TexelCover(kLayerCountMax, true);
  uint corner = 0u;  // 0: the column next to the facet
  for (;;) {
    if (layer_count == kLayerCountMax + 1u) break;  // shaders/README.md, Loops
    const bvec2 is_last = bvec2((corner & 1u) != 0u, (corner & 2u) != 0u);
    const ivec2 column = corner == 0u ? clamp(place.cell, first, last) : mix(first, last, is_last);
    const uint layer =
        continuingLayer(layers, layer_count, extent, place.layer, place.cell, column, kappa);
    const bool continues = layer != kLayerCountMax;
    const uint links = loadLinks(layers, continues ? layer : 0u, extent, column);
    const bool is_mixed = isMixedBetween(links, low - vec2(column), high - vec2(column));
    cover.layer = corner == 0u ? layer : cover.layer;
    cover.is_of_it = cover.is_of_it && continues && !is_mixed;
    ++corner;
    if (!cover.is_of_it || first == last || corner == 5u) break;
  }
  return cover;
}

// Where colour of another size is taken from. `kappa`: of stepAt. `clean`: by which what
// may be mixed gives way, 0..1.
struct ScaledColor {
  Address texels[kLayerCountMax];
  ColorSizes sizes;
  uint format;
  uint layer_count;
  vec3 kappa;
  float clean;
};

// Texels by their weights: `all` that continue a facet, and these less what may be mixed.
struct TexelSums {
  vec4 all;
  float all_weight;
  vec4 clean;
  float clean_weight;
};

void addTexel(Address layers[kLayerCountMax], Extent extent, ScaledColor from, SurfacePlace place,
              vec2 texel, float weight, inout TexelSums sums) {
  const vec2 size_px = vec2(colorSize(from.sizes, place.layer));
  const vec2 inside = clamp(texel, vec2(0.0), size_px - 1.0);
  const vec2 px_per_texel = vec2(extent.size_px) / size_px;
  const TexelCover cover = coverOf(layers, from.layer_count, extent, place, inside * px_per_texel,
                                   (inside + 1.0) * px_per_texel, from.kappa);
  if (cover.layer == kLayerCountMax) return;
  const vec4 held = texelAtUv(from.texels, from.sizes, from.format, cover.layer,
                              (inside + 0.5) / size_px);
  const float clean_weight = cover.is_of_it ? weight : weight * (1.0 - from.clean);
  sums.all += weight * held;
  sums.all_weight += weight;
  sums.clean += clean_weight * held;
  sums.clean_weight += clean_weight;
}

// Bilinear over the texels around the place in the plane of its layer whose columns continue its
// facet; what another layer continues is looked up in that layer's plane. Where all of them may be
// mixed, those around them.
vec4 surfaceColorScaled(Address layers[kLayerCountMax], Extent extent, ScaledColor from,
                        SurfacePlace met) {
  SurfacePlace place = met;
  const vec2 px_per_texel = vec2(extent.size_px) / vec2(colorSize(from.sizes, met.layer));
  moveFurtherIn(layers, extent, kEdgeLeft, px_per_texel.x, from.clean, place);
  moveFurtherIn(layers, extent, kEdgeTop, px_per_texel.y, from.clean, place);
  const vec2 position = round((place.point / px_per_texel - 0.5) * kSubtexelSteps) / kSubtexelSteps;
  const vec2 share = position - floor(position);
  TexelSums sums = TexelSums(vec4(0.0), 0.0, vec4(0.0), 0.0);
  for (int i = 0; i < 4; ++i) {
    const vec2 corner = vec2(i & 1, i >> 1);
    const vec2 shares = mix(1.0 - share, share, equal(corner, vec2(1.0)));
    addTexel(layers, extent, from, place, floor(position) + corner, shares.x * shares.y, sums);
  }
  if (sums.clean_weight == 0.0 && from.clean > 0.0) {
    uint around = 0u;
    for (;;) {
      if (from.layer_count == kLayerCountMax + 2u) break;  // shaders/README.md, Loops
      const vec2 offset = vec2(around % 3u, around / 3u) - 1.0;
      addTexel(layers, extent, from, place, round(position) + offset, 1.0, sums);
      ++around;
      if (around == 9u) break;
    }
  }
  if (sums.clean_weight > 0.0) return sums.clean / sums.clean_weight;
  if (sums.all_weight > 0.0) return sums.all / sums.all_weight;
  // The texel that is nearest within the facet.
  const vec2 inside = clamp(met.point - vec2(met.cell), kCoverRounding_px, 1.0 - kCoverRounding_px);
  return texelAtUv(from.texels, from.sizes, from.format, met.layer,
                   (vec2(met.cell) + inside) / vec2(extent.size_px));
}

#endif  // VIEWLOOM_LIB_LIGHT_SCALED_COLOR_GLSL_
