// SPDX-License-Identifier: Apache-2.0
// Reading of a source by rivals, and the colour of a px from the hit of its ray.
#ifndef VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_
#define VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/light/srgb.glsl"
#include "rival_run.glsl"

layout(set = 0, binding = kBindingColor) uniform usamplerBuffer color_texels;
layout(set = 0, binding = kBindingInvZ) uniform samplerBuffer inv_z_texels;

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
  return max(push.kappa.x, push.kappa.y * (nearer_inv_z - push.kappa.z));
}

// Weight of a tap that belongs to the surface of `own` or not.
float weightIfLinked(float weight, float inv_z, float own) {
  const bool is_linked = inv_z >= 0.0 && abs(inv_z - own) <= kappaOf(max(inv_z, own));
  return is_linked ? weight : 0.0;
}

// Bilinear over the up to four px around the point that are no further from the px hit than kappa,
// in the codes and with the positions of lib/light/color.glsl. A layer alone: links between layers
// are viewloom's.
vec3 codesAt(uint layer, ivec2 cell, vec2 point) {
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
    sum += weights[i] * codesOfRgba8(texelFetch(color_texels, taps[i]).x);
  }
  return sum * (1.0 / (weights.x + weights.y + weights.z + weights.w));
}

// Hit of a ray. Without one: the place whose colour goes on.
struct Found {
  bool is_hit;
  bool is_hidden;  // no hit, and behind some surface at the end
  float t;
  float middle_t;  // inside the px hit, where `t` may be on its edge
  uint layer;
};

const float kNotPassed = 2.0;  // beyond every ray

// A layer is done: what the ray met in it, between enter_t and exit_t, a px of this inv_z; or where
// it first was behind it. `stop_t`: what is further along is of no interest.
void finishLayer(Ray ray, uint layer, bool meets, float inv_z, float enter_t, float exit_t,
                 float passed_t, inout Found found, inout float stop_t) {
  if (meets) {
    found.is_hit = true;
    found.t = max(enter_t, (inv_z - ray.start.z) / ray.extent.z);
    found.middle_t = 0.5 * (enter_t + exit_t);
    found.layer = layer;
    stop_t = found.t;
  }
  if (!found.is_hit && passed_t < kNotPassed) {
    found.is_hidden = true;
    found.t = passed_t - 0.5 * min(ray.pace.x, ray.pace.y);
    found.middle_t = found.t;
    found.layer = layer;
  }
}

// A miss continues the surface before the silhouette that the ray first passed behind, half a px
// away from it; or the image's border, or shows the background.
uint codeOf(Ray ray, Found found) {
  const vec2 point = ray.start.xy + found.t * ray.extent.xy;
  const vec2 middle = ray.start.xy + found.middle_t * ray.extent.xy;
  const ivec2 cell = ivec2(clamp(middle, vec2(0.0), vec2(sourceSize() - 1)));
  const vec3 codes = codesAt(found.layer, cell, point);
  const bool is_border = !ray.is_endless && (push.fill & kFillBorder) != 0u;
  const bool is_known = found.is_hit || found.is_hidden || is_border;
  return is_known ? packCodes(codes) : push.fill | kOpaqueCode;
}

Ray rayOf(ViewParams view, vec2 tile_px) {
  return makePlainRay(view.eye * push.inv_z_near, rayDirection(view, tile_px), vec2(sourceSize()),
                      push.inv_z_near);
}

#endif  // VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_
