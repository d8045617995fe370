// SPDX-License-Identifier: Apache-2.0
// What rivals read of a source: inv_z of each layer and its colour, all as texels.
#ifndef VIEWLOOM_BENCH_RIVAL_SOURCE_GLSL_
#define VIEWLOOM_BENCH_RIVAL_SOURCE_GLSL_

#include "lib/srgb.glsl"
#include "rival_abi.h"

layout(push_constant, scalar) uniform Push {
  RivalPush push;
};
layout(set = 0, binding = kBindingColor) uniform usamplerBuffer color_texels;
layout(set = 0, binding = kBindingInvZ) uniform samplerBuffer inv_z_texels;

// False, which no compiler knows: shaders/README.md, Loops.
bool isNever(uint loop) {
  return push.layer_count == kLayerCountMax + 1u + loop;
}

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

ivec2 sourceSize() {
  return ivec2(unpackSize(push.source_size_px));
}

// Where the px of a layer lie; around the image is a guard of no surface (shared/structure_abi.h).
int layerBegin(uint layer) {
  const uvec2 size_px = unpackSize(push.source_size_px);
  return int(layer * invZArea(size_px.x, size_px.y));
}

int pixelIndex(ivec2 pixel) {
  return int(invZIndex(invZPitch(push.source_size_px & 0xffffu), uint(pixel.x), pixel.y));
}

float kappaOf(float nearer_inv_z) {
  return max(push.kappa_abs, push.kappa_rel * nearer_inv_z);
}

// Weight of a tap that belongs to the surface of `own` or not.
float weightIfLinked(float weight, float inv_z, float own) {
  const bool is_linked = inv_z >= 0.0 && abs(inv_z - own) <= kappaOf(max(inv_z, own));
  return is_linked ? weight : 0.0;
}

// Bilinear over the up to four px around the point that are no further from the px hit than kappa,
// in the light and with the positions of lib/color.glsl. A layer alone: links between layers are
// viewloom's.
vec3 lightAt(uint layer, ivec2 cell, vec2 point) {
  const vec2 offset = round((point - vec2(cell) - 0.5) * 256.0) / 256.0;
  const vec2 share = min(abs(offset), vec2(0.5));
  const vec2 other = 1.0 - share;
  const ivec2 toward = ivec2(offset.x >= 0.0 ? 1 : -1, offset.y >= 0.0 ? 1 : -1);
  const ivec2 size_px = sourceSize();
  const int pitch = int(invZPitch(uint(size_px.x)));
  const int at = layerBegin(layer) + pixelIndex(cell);
  const int step_y = toward.y > 0 ? pitch : -pitch;
  const float own = texelFetch(inv_z_texels, at).x;
  const float inv_z_x = texelFetch(inv_z_texels, at + toward.x).x;
  const float inv_z_y = texelFetch(inv_z_texels, at + step_y).x;
  const float inv_z_xy = texelFetch(inv_z_texels, at + toward.x + step_y).x;
  const vec4 weights = vec4(other.x * other.y, weightIfLinked(share.x * other.y, inv_z_x, own),
                            weightIfLinked(other.x * share.y, inv_z_y, own),
                            weightIfLinked(share.x * share.y, inv_z_xy, own));
  // A tap that takes no part loads the px itself.
  const int texel = (int(layer) * size_px.y + cell.y) * size_px.x + cell.x;
  const int down = toward.y > 0 ? size_px.x : -size_px.x;
  const ivec4 taps = texel + ivec4(0, weights.y > 0.0 ? toward.x : 0, weights.z > 0.0 ? down : 0,
                                   weights.w > 0.0 ? toward.x + down : 0);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    sum += weights[i] * lightFromCodes(texelFetch(color_texels, taps[i]).x);
  }
  return sum * (1.0 / (weights.x + weights.y + weights.z + weights.w));
}

#endif  // VIEWLOOM_BENCH_RIVAL_SOURCE_GLSL_
