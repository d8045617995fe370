// SPDX-License-Identifier: Apache-2.0
// The colour of a surface point, interpolated within its connected surface and never across a
// silhouette.
#ifndef VIEWLOOM_LIB_LIGHT_COLOR_GLSL_
#define VIEWLOOM_LIB_LIGHT_COLOR_GLSL_

#include "lib/light/srgb.glsl"
#include "lib/structure/structure_access.glsl"

// Whether texels are codes 0..255, and blends of them, too.
bool holdsCodes(uint color_format) {
  return color_format == kColorRgba8 || color_format == kColorCodes11;
}

// holdsCodes: codes. kColorRgb16: roots of light. Else premultiplied linear BT.709.
// `count`: texels of a layer.
vec4 loadTexel(Address color[kLayerCountMax], uint layer, uint count, uint color_format,
               uint index) {
  uvec2 bits;
  if (!kReadByAddress)
    bits = texelFetch(color_texels, int(layer * count + index)).xy;
  else if (!holdsCodes(color_format))
    bits = Uvec2Ref(pickAddress(color, layer)).at[index];
  else
    bits = uvec2(UintRef(pickAddress(color, layer)).at[index], 0u);
  if (color_format == kColorRgba8) return vec4(codesOfRgba8(bits.x), 1.0);
  if (color_format == kColorCodes11) return vec4(codesOfRgb11(bits.x), 1.0);
  if (color_format == kColorRgb16) return vec4(rootsOfRgb16(bits), 1.0);
  return vec4(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y));
}

// Sub-texel positions have 1/256 px, as in texture units: a ray through a sample's centre returns
// the sample, whatever the last bits of its position.
const float kSubtexelSteps = 256.0;

// The sample of a column and the one beside it, between which colour is looked up along an axis.
struct AxisTaps {
  int toward;     // -1 or 1: where the other lies
  float share;    // of the other
  uint link;      // to the other
  bool is_inner;  // the own sample stands beside a deep silhouette, the other further in
};

// `low_edge`: of the two along the axis. `offset`: of the point from the own sample, px. `clean`:
// see surfaceColorPerFacet.
AxisTaps tapsAlong(uint links, uint low_edge, float offset, float clean) {
  const bool deep_low = isDeepEdge(links, low_edge);
  const bool deep_high = isDeepEdge(links, low_edge + 1u);
  const uint inner_link = linkOfEdge(links, deep_low ? low_edge + 1u : low_edge);
  const bool is_inner = deep_low != deep_high && inner_link > 0u;
  const int towards_point = offset >= 0.0 ? 1 : -1;
  const int toward = is_inner ? (deep_low ? 1 : -1) : towards_point;
  const float share = clamp(offset * float(toward), 0.0, 1.0);
  const uint link = linkOfEdge(links, toward > 0 ? low_edge + 1u : low_edge);
  return AxisTaps(toward, is_inner ? mix(share, 1.0, clean) : share, link, is_inner);
}

// The same for the other sample, whose links are known now.
float shareOfOther(AxisTaps taps, uint other_links, uint low_edge, float offset, float clean) {
  const bool is_deep = isDeepEdge(other_links, taps.toward > 0 ? low_edge + 1u : low_edge);
  // A surface of two pixels between two silhouettes has no others.
  const float plain = clamp(offset * float(taps.toward), 0.0, 1.0);
  return is_deep ? (taps.is_inner ? plain : plain * (1.0 - clean)) : taps.share;
}

// The samples that what is seen at a place of a surface is blended of: the own one, that beside it
// along x, along y, and the fourth. Those that take no part are the own one, with weight 0.
struct SurfaceTaps {
  uvec4 layers;
  ivec4 px;  // y * width + x
  vec4 weights;
};

// Bilinear over the up to four facets around the point that are linked. A tap that takes no part
// loads the facet's own texel with weight 0: a branch would cost as much. `links`: of the facet.
// `clean`, by axis: how far the samples on the far side of deep silhouettes give way to those one
// px further in, 0..1.
SurfaceTaps surfaceTaps(Address layers[kLayerCountMax], Extent extent, uint layer, ivec2 cell,
                        uint links, vec2 point, vec2 clean) {
  const vec2 offset = round((point - vec2(cell) - 0.5) * kSubtexelSteps) / kSubtexelSteps;
  const AxisTaps taps_x = tapsAlong(links, kEdgeLeft, offset.x, clean.x);
  const AxisTaps taps_y = tapsAlong(links, kEdgeTop, offset.y, clean.y);
  const uint link_x = taps_x.link;
  const uint link_y = taps_y.link;
  const ivec2 step_x = ivec2(link_x > 0u ? taps_x.toward : 0, 0);
  const ivec2 step_y = ivec2(0, link_y > 0u ? taps_y.toward : 0);
  const uint layer_x = link_x > 0u ? link_x - 1u : layer;
  const uint layer_y = link_y > 0u ? link_y - 1u : layer;
  const uint links_x = loadLinks(layers, layer_x, extent, cell + step_x);
  const uint links_y = loadLinks(layers, layer_y, extent, cell + step_y);
  const vec2 share = vec2(shareOfOther(taps_x, links_x, kEdgeLeft, offset.x, clean.x),
                          shareOfOther(taps_y, links_y, kEdgeTop, offset.y, clean.y));
  // The fourth is reached through either neighbour.
  const uint edge_x = taps_x.toward > 0 ? kEdgeRight : kEdgeLeft;
  const uint edge_y = taps_y.toward > 0 ? kEdgeBottom : kEdgeTop;
  const uint through_x = link_x > 0u ? linkOfEdge(links_x, edge_y) : 0u;
  const uint through_y = link_x == 0u && link_y > 0u ? linkOfEdge(links_y, edge_x) : 0u;
  const uint link_xy = max(through_x, through_y);

  const vec2 other = 1.0 - share;
  const int own = cell.y * extent.size_px.x + cell.x;
  const int down = taps_y.toward * extent.size_px.x;
  SurfaceTaps taps;
  taps.weights =
      vec4(other.x * other.y, link_x > 0u ? share.x * other.y : 0.0,
           link_y > 0u ? other.x * share.y : 0.0, link_xy > 0u ? share.x * share.y : 0.0);
  // Samples further in stand for the own one along both axes, and nothing leads to the fourth.
  const float sum = taps.weights.x + taps.weights.y + taps.weights.z + taps.weights.w;
  if (sum <= 0.0) taps.weights.y = 1.0;
  taps.layers = uvec4(layer, layer_x, layer_y, link_xy > 0u ? link_xy - 1u : layer);
  taps.px = ivec4(own, link_x > 0u ? own + taps_x.toward : own, link_y > 0u ? own + down : own,
                  link_xy > 0u ? own + taps_x.toward + down : own);
  return taps;
}

// Colour planes of the depth's size: one texel a facet. Arguments as of surfaceTaps.
vec4 surfaceColorPerFacet(Address layers[kLayerCountMax], Address color[kLayerCountMax],
                          Extent extent, uint color_format, uint layer, ivec2 cell, uint links,
                          vec2 point, vec2 clean) {
  const SurfaceTaps taps = surfaceTaps(layers, extent, layer, cell, links, point, clean);
  const uint count = uint(extent.size_px.x * extent.size_px.y);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    sum += taps.weights[i] *
           loadTexel(color, taps.layers[i], count, color_format, uint(taps.px[i]));
  }
  return sum * (1.0 / (taps.weights.x + taps.weights.y + taps.weights.z + taps.weights.w));
}

// Sizes of colour planes that are not all the depth's: width | height << 16 of each layer, and the
// texels from layer to layer.
struct ColorSizes {
  uint size_px[kLayerCountMax];
  uint stride;
};

ivec2 colorSize(ColorSizes sizes, uint layer) {
  const uint low = layer == 0u ? sizes.size_px[0] : sizes.size_px[1];
  const uint high = layer == 2u ? sizes.size_px[2] : sizes.size_px[3];
  const uint size_px = layer < 2u ? low : high;
  return ivec2(size_px & 0xffffu, size_px >> 16);
}

#endif  // VIEWLOOM_LIB_LIGHT_COLOR_GLSL_
