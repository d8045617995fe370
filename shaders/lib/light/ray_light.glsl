// SPDX-License-Identifier: Apache-2.0
// Colour of a pixel from the hit of its ray.
#ifndef VIEWLOOM_LIB_LIGHT_RAY_LIGHT_GLSL_
#define VIEWLOOM_LIB_LIGHT_RAY_LIGHT_GLSL_

#include "lib/light/color.glsl"
#include "lib/rays/extras.glsl"
#include "lib/walk/far_side.glsl"
#include "lib/rays/ray.glsl"
#include "lib/light/scaled_color.glsl"
#include "lib/walk/walk.glsl"

// Light that is left after semitransparent surfaces and is not worth another surface.
const float kTransmittanceMin = 1.0 / 255.0;

// The colours of a scene, for those functions below that take it. `format` and `is_scaled` are
// constants of the kernel.
void addColor(inout Scene scene, Address texels[kLayerCountMax], uint format, bool is_scaled) {
  scene.color = ColorPlanes(texels, format, is_scaled);
}

// `clean`: of lib/light/color.glsl.
vec4 surfaceColor(Scene scene, uint layer, ivec2 cell, uint links, vec2 point, vec2 clean) {
  if (scene.color.is_scaled) {
    // By either axis: texels are no columns, and what a silhouette has mixed with one of them along
    // one axis shows along the other.
    const ScaledColor from =
        ScaledColor(scene.color.texels, ColorSizes(extras.color_size_px, extras.color_stride),
                    scene.color.format, scene.layer_count, scene.kappa, max(clean.x, clean.y));
    return surfaceColorScaled(scene.layers, scene.extent, from,
                              SurfacePlace(point, cell, layer, links));
  }
  return surfaceColorPerFacet(scene.layers, scene.color.texels, scene.extent, scene.color.format,
                              layer, cell, links, point, clean);
}

// Codes 0..255 of a blend of texels.
vec3 codesOfBlend(vec3 blend, uint color_format) {
  if (holdsCodes(color_format)) return blend;
  return color_format == kColorRgb16 ? codesFromRoots(blend) : codesFromLinear(blend);
}

// The background as texels are held. `fill`: of TracePush.
vec3 blendOfBackground(uint fill, uint color_format) {
  const vec3 codes = vec3(uvec3(fill, fill >> 8, fill >> 16) & 255u);
  if (holdsCodes(color_format)) return codes;
  const vec3 light = linearFromSrgb(codes / 255.0);
  return color_format == kColorRgb16 ? rootsFromLinear(light) : light;
}

// Colour of a pixel; if nothing is known, the background. In units of texels
// (lib/light/color.glsl).
struct Light {
  vec4 color;  // premultiplied
  bool is_known;
};

// How far a view moves the nearest against the furthest, px: from the source's own place the source
// is seen as it is, from a px beside it none of the samples that may be mixed. By axis.
vec2 cleanShare(Scene scene, Ray ray) {
  const float range = scene.inv_z_range / max(scene.inv_z_range, abs(ray.extent.z));
  return min(abs(ray.extent.xy) * range, vec2(1.0));
}

// The next surface behind the one that a ray hit. Where that is rough its own facets may be met
// again, so what lies behind is further from it than what would be connected. Where there is none,
// or nothing was hit, the first answer.
Walk walkBehind(Scene scene, ViewParams view, Ray ray, Walk first) {
  const float hit_inv_z = ray.start.z + first.t * ray.extent.z;
  const float apart = stepAt(scene.kappa, hit_inv_z);
  Walk walk = first;
  for (;;) {
    if (isNever(scene, 9u) || !first.is_hit) break;
    const WalkStart behind = WalkStart(walk.t, walk.cell, walk.layer + 1u);
    walk = walkRay(scene, kSeesThroughSurfaces, ray, behind, view.inv_z_tolerance, view.eye.z);
    const float inv_z = ray.start.z + walk.t * ray.extent.z;
    if (!walk.is_hit || abs(hit_inv_z - inv_z) > apart) break;
  }
  if (walk.is_hit) return walk;
  return first;
}

// Light of the surface that is hit. Without one, the far side of the silhouette that the ray passed
// behind goes on, or the image's border; else there is nothing. The far side may be found only now.
Light surfaceLight(Scene scene, Ray ray, WalkStart start, inout Walk walk) {
  findFarSide(scene, ray, start, walk);
  const vec3 point = ray.start + walk.t * ray.extent;
  const bool is_far_side = !walk.is_hit && walk.ends_behind && walk.has_far_side;
  const bool is_border = walk.leaves && scene.fills_border;
  const uint layer = walk.is_hit ? walk.layer : is_far_side ? walk.far_layer : 0u;
  const ivec2 cell = is_far_side ? walk.far_cell : walk.cell;
  const vec2 at = walk.is_hit     ? point.xy
                  : is_far_side ? farPoint(ray, walk)
                                : vec2(cell) + 0.5;
  const uint own_links = loadLinks(scene.layers, layer, scene.extent, cell);
  const ivec2 direction = mix(ivec2(1), ivec2(-1), lessThan(ray.extent.xy, vec2(0.0)));
  const uint near_edge = edgeOfAxis(walk.far_axis, direction, true);
  const uint links = is_far_side && walk.far_share > 0.0
                         ? withLink(own_links, near_edge, layer + 1u)
                         : own_links;
  const bool goes_on = walk.ends_behind && !lacksFarSide(walk, start);
  const bool is_known = walk.is_hit || goes_on || is_border;
  const vec4 color = surfaceColor(scene, layer, cell, links, at, cleanShare(scene, ray));
  return Light(color, is_known && (own_links & kFacetExists) != 0u);
}

// Opaque sources end at the first surface.
Light opaqueLight(Scene scene, Ray ray, inout Walk walk) {
  return surfaceLight(scene, ray, WalkStart(0.0, walk.cell, 0u), walk);
}

// Semitransparent ones are composited front to back: each surface is walked on from, behind it. One
// that is rough may be met again, in the same layer and no further on than what would be connected:
// it counts once.
Light layeredLight(Scene scene, ViewParams view, Ray ray, Walk first, vec3 background) {
  vec3 light = vec3(0.0);
  float transmittance = 1.0;
  Walk walk = first;
  WalkStart behind = WalkStart(0.0, first.cell, 0u);
  uint counted_layer = kNoLayer;
  float counted_inv_z = 0.0;
  for (;;) {
    const Light seen = surfaceLight(scene, ray, behind, walk);
    const vec4 last = vec4(seen.is_known ? seen.color.rgb : background, 1.0);
    const vec4 color = walk.is_hit ? seen.color : last;
    const float inv_z = ray.start.z + walk.t * ray.extent.z;
    const float apart = stepAt(scene.kappa, counted_inv_z);
    const bool is_counted =
        walk.is_hit && walk.layer == counted_layer && abs(counted_inv_z - inv_z) <= apart;
    light += is_counted ? vec3(0.0) : transmittance * color.rgb;
    transmittance *= is_counted ? 1.0 : 1.0 - color.a;
    counted_inv_z = is_counted ? counted_inv_z : inv_z;
    counted_layer = walk.layer;
    if (!walk.is_hit || transmittance <= kTransmittanceMin) return Light(vec4(light, 1.0), true);
    behind = WalkStart(walk.t, walk.cell, walk.layer + 1u);
    walk = walkRay(scene, kSeesThroughSurfaces, ray, behind, view.inv_z_tolerance, view.eye.z);
  }
}

#endif  // VIEWLOOM_LIB_LIGHT_RAY_LIGHT_GLSL_
