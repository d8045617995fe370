// SPDX-License-Identifier: Apache-2.0
// Traces a band of an atlas: one ray per px of every view, by the walk.
//
// An invocation takes kPixelsPerInvocation neighbouring px of one view, so that they can share the
// bound where their rays may start. Neighbouring invocations are neighbouring *views* where the
// atlas has enough columns: between views a ray moves less in the source than between px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/trace_abi.h"
#include "lib/color.glsl"
#include "lib/walk.glsl"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kOwnConstants + 0u) const uint kWanted = 0u;  // kWant... flags
layout(constant_id = kOwnConstants + 1u) const uint kColorFormat = kColorRgba8;
layout(constant_id = kOwnConstants + 2u) const uint kPixelsPerInvocation = 8u;
layout(constant_id = kOwnConstants + 3u) const bool kLanesAreViews = true;
// Colour planes of another size than depth
layout(constant_id = kOwnConstants + 4u) const bool kColorIsScaled = false;
layout(push_constant, scalar) uniform Push { TracePush push; };

layout(set = 0, binding = kBindingViews, scalar) readonly buffer Views { ViewParams views[]; };
layout(set = 0, binding = kBindingExtras, scalar) uniform Extras { TraceExtras extras; };
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band { uint band[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef {
  RayRecord at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer Vec4Ref {
  vec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref {
  uint8_t at[];
};

// Light that is left after semitransparent surfaces and is not worth another surface.
const float kTransmittanceMin = 1.0 / 255.0;
// Cells of this level share a start bound; rays over more of them start at the bound of the whole
// source.
const uint kStartLevel = 5u;
const int kStartCellsMax = 16;
// Distance a start keeps from the bound, as a share of the largest inv_z: 16 ulp, more than the
// rounding of positions along a ray.
const float kStartMargin = 16.0 / 8388608.0;

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

vec4 surfaceColor(Scene scene, uint layer, ivec2 cell, vec2 point) {
  if (kColorIsScaled) {
    const ColorSizes sizes = ColorSizes(extras.color_size_px, extras.color_stride);
    return surfaceColorScaled(scene.layers, push.color, scene.layer_count, scene.extent, sizes,
                              kColorFormat, layer, cell, point, scene.kappa);
  }
  return surfaceColorPerFacet(scene.layers, push.color, scene.extent, kColorFormat, layer, cell,
                              point);
}

// Cells that neighbouring rays pass, and the largest inv_z in them.
struct StartRegion {
  vec2 low_px;
  vec2 high_px;
  float bound;
};

StartRegion startRegion(Scene scene, vec2 low_px, vec2 high_px) {
  const ivec2 last_cell = (scene.extent.size_px - 1) >> int(kStartLevel);
  const ivec2 first = clamp(ivec2(floor(low_px)) >> int(kStartLevel), ivec2(0), last_cell);
  const ivec2 last = clamp(ivec2(floor(high_px)) >> int(kStartLevel), ivec2(0), last_cell);
  const ivec2 count = last - first + 1;
  const float cell_px = float(1u << kStartLevel);
  StartRegion region =
      StartRegion(vec2(first) * cell_px, vec2(last + 1) * cell_px, scene.inv_z_near);
  if (count.x * count.y > kStartCellsMax) return region;
  float bound = 0.0;
  ivec2 cell = first;
  for (int i = 0; i < count.x * count.y; ++i) {
    const uvec2 bits = loadCell(scene.layers, 0u, scene.extent, kStartLevel, uvec2(cell));
    bound = max(bound, nodeBox(unpackNode(bits)).y);
    cell = cell.x == last.x ? ivec2(first.x, cell.y + 1) : ivec2(cell.x + 1, cell.y);
  }
  region.bound = min(bound + kStartMargin * scene.inv_z_near, scene.inv_z_near);
  return region;
}

// The start of a ray: as far along as nothing can be, then the column it is in. A wide fan of rays
// clipped by the image may pass cells between the first and the last ray that neither of the two
// passes.
WalkStart startOf(Scene scene, Ray ray, StartRegion region) {
  const vec2 end = (ray.start + ray.extent).xy;
  const bool is_covered = all(greaterThanEqual(min(ray.start.xy, end), region.low_px)) &&
                          all(lessThanEqual(max(ray.start.xy, end), region.high_px));
  const float bound = is_covered ? region.bound : scene.inv_z_near;
  const bool goes_away = ray.extent.z < 0.0 && ray.start.z > bound;
  const float t = goes_away ? min((bound - ray.start.z) / ray.extent.z, 1.0) : 0.0;
  const ivec2 cell = ivec2(floor((ray.start + t * ray.extent).xy));
  return WalkStart(Place(t, clamp(cell, ivec2(0), scene.extent.size_px - 1), kAxisNone),
                   kStateUnknown);
}

uint classOf(Walk walk) {
  const uint hit = walk.is_assumed ? kClassHitAssumed : kClassHit;
  const uint no_hit = walk.ends_behind ? kClassHidden : walk.leaves ? kClassOutside : kClassEmpty;
  return walk.is_hit ? hit : no_hit;
}

// A ray that never sees the image continues the border next to where it goes.
Walk walkBeside(Scene scene, vec3 direction) {
  const vec2 toward =
      direction.z > 0.0 ? direction.xy / direction.z : 0.5 * vec2(scene.extent.size_px);
  const ivec2 cell = ivec2(clamp(toward, vec2(0.0), vec2(scene.extent.size_px - 1)));
  return Walk(false, false, false, true, 1.0, cell, 0u, false, cell, 0u, 0u);
}

// What stands where a walk ends. Without a hit: the far side of the silhouette the ray passed
// behind, or the image's border, goes on; else there is nothing (layer kLayerCountMax).
struct Place2d {
  uint layer;
  ivec2 cell;
};

Place2d fillPlace(Scene scene, Walk walk) {
  const bool is_far_side = walk.ends_behind && walk.has_far_side;
  const uint layer = is_far_side ? walk.far_layer : 0u;
  const ivec2 cell = is_far_side ? walk.far_cell : walk.cell;
  const bool is_border = walk.leaves && (push.fill & kFillBorder) != 0u;
  const bool is_known = walk.ends_behind || is_border;
  const uvec2 facet = loadFacet(scene.layers, layer, scene.extent, cell);
  return Place2d(is_known && facet.x != kNoFacet ? layer : kLayerCountMax, cell);
}

// Opaque sources end at the first surface, or at its fill.
vec3 opaqueLight(Scene scene, Ray ray, Walk walk) {
  const vec3 point = ray.start + walk.t * ray.extent;
  const Place2d fill = fillPlace(scene, walk);
  const uint layer = walk.is_hit ? walk.layer : fill.layer;
  const ivec2 cell = walk.is_hit ? walk.cell : fill.cell;
  const bool is_surface = layer < kLayerCountMax;
  const vec2 at = walk.is_hit ? point.xy : vec2(cell) + 0.5;
  const vec4 color = surfaceColor(scene, is_surface ? layer : 0u, cell, at);
  return is_surface ? color.rgb : linearFromSrgb(unpackUnorm4x8(push.fill).bgr);
}

// Semitransparent ones are composited front to back: each surface is walked on from, behind it.
vec3 layeredLight(Scene scene, ViewParams view, Ray ray, Walk first) {
  vec3 light = vec3(0.0);
  float transmittance = 1.0;
  Walk walk = first;
  for (;;) {
    const vec3 point = ray.start + walk.t * ray.extent;
    const vec4 color = walk.is_hit ? surfaceColor(scene, walk.layer, walk.cell, point.xy)
                                   : vec4(opaqueLight(scene, ray, walk), 1.0);
    light += transmittance * color.rgb;
    transmittance *= 1.0 - color.a;
    if (!walk.is_hit || transmittance <= kTransmittanceMin) return light;
    const WalkStart behind = WalkStart(Place(walk.t, walk.cell, kAxisNone), walk.layer + 1u);
    walk = walkRay(scene, ray, behind, view.inv_z_tolerance, view.eye.z);
  }
}

void store(uint index, vec3 light, Walk walk, Ray ray, vec3 eye, vec3 direction) {
  const vec3 srgb = srgbFromLinear(light);
  band[index] = packUnorm4x8(vec4(srgb, 1.0));
  if (kWanted == 0u) return;
  const vec3 point = ray.start + walk.t * ray.extent;
  const uint ray_class = classOf(walk);
  if ((kWanted & kWantDepth) != 0u) {
    FloatRef(extras.depth).at[index] = walk.is_hit ? viewInvZ(eye, direction, point) : 0.0;
  }
  if ((kWanted & kWantMask) != 0u) Uint8Ref(extras.mask).at[index] = uint8_t(ray_class);
  if ((kWanted & kWantLinear) != 0u) Vec4Ref(extras.linear).at[index] = vec4(srgb, 1.0);
  if ((kWanted & kWantRecords) != 0u) {
    RecordsRef(extras.records).at[index] =
        RayRecord(point.x, point.y, point.z, ray_class, walk.layer, walk.visits);
  }
}

// A run of px of one row of one view, and where it lies in the band.
struct Run {
  uint first_x;
  uint count;
  float tile_y;
  uint first_index;
};

Ray rayOfPixel(Scene scene, ViewParams view, Run run, uint i, out vec3 direction) {
  direction = rayDirection(view, vec2(float(run.first_x + i) + 0.5, run.tile_y));
  return makeRay(view.eye, direction, vec2(scene.extent.size_px), scene.inv_z_near);
}

StartRegion regionOfRun(Scene scene, ViewParams view, Run run) {
  vec3 direction;
  const Ray first = rayOfPixel(scene, view, run, 0u, direction);
  const Ray last = rayOfPixel(scene, view, run, run.count - 1u, direction);
  const vec2 first_end = (first.start + first.extent).xy;
  const vec2 last_end = (last.start + last.extent).xy;
  const vec2 low = min(min(first.start.xy, last.start.xy), min(first_end, last_end));
  const vec2 high = max(max(first.start.xy, last.start.xy), max(first_end, last_end));
  StartRegion region = startRegion(scene, low, high);
  if (!first.is_inside || !last.is_inside) region.bound = scene.inv_z_near;
  return region;
}

void traceRun(Scene scene, ViewParams view, Run run, inout uint counts[kClassCount]) {
  const StartRegion region = regionOfRun(scene, view, run);
  for (uint i = 0u; i < run.count; ++i) {
    vec3 direction;
    const Ray ray = rayOfPixel(scene, view, run, i, direction);
    Walk walk = walkBeside(scene, direction);
    if (ray.is_inside)
      walk = walkRay(scene, ray, startOf(scene, ray, region), view.inv_z_tolerance, view.eye.z);
    const vec3 light = kColorFormat == kColorRgba8 ? opaqueLight(scene, ray, walk)
                                                   : layeredLight(scene, view, ray, walk);
    store(run.first_index + i, light, walk, ray, view.eye, direction);
    const uint ray_class = classOf(walk);
    for (uint k = kClassHit; k < kClassCount; ++k) counts[k] += k == ray_class ? 1u : 0u;
  }
}

void main() {
  const uvec2 tile_size = unpackSize(push.tile_size_px);
  const uvec2 tile_grid = unpackSize(push.tile_grid);
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint invocation = gl_GlobalInvocationID.x;
  const uint runs = (tile_size.x + kPixelsPerInvocation - 1u) / kPixelsPerInvocation;
  const uint column = kLanesAreViews ? invocation % tile_grid.x : invocation / runs;
  const uint run_in_tile = kLanesAreViews ? invocation / tile_grid.x : invocation % runs;
  const uint tile_row =
      row < push.padding_top_px ? tile_grid.y : (row - push.padding_top_px) / tile_size.y;
  const bool exists = run_in_tile < runs && column < tile_grid.x && tile_row < tile_grid.y;
  const uint tile = exists ? tile_row * tile_grid.x + column : 0u;
  const ViewParams view = views[tile];

  uint counts[kClassCount];
  for (uint k = 0u; k < kClassCount; ++k) counts[k] = 0u;
  if (exists && view.is_used != 0u) {
    Scene scene;
    scene.layers = push.layers;
    scene.layer_count = push.layer_count;
    scene.extent = makeExtent(ivec2(unpackSize(push.source_size_px)));
    // A little in front of everything; never 0, it is a divisor.
    scene.inv_z_near = max(uintBitsToFloat(measured_head.inv_z_max_bits), 1e-12) * 1.0001;
    scene.kappa = vec2(measured_head.kappa_abs, measured_head.kappa_rel);
    Run run;
    run.first_x = run_in_tile * kPixelsPerInvocation;
    run.count = min(kPixelsPerInvocation, tile_size.x - run.first_x);
    run.tile_y = float(row - push.padding_top_px - tile_row * tile_size.y) + 0.5;
    run.first_index = gl_WorkGroupID.y * push.atlas_width_px + column * tile_size.x + run.first_x;
    traceRun(scene, view, run, counts);
  }
  for (uint k = kClassHit; k < kClassCount; ++k) {
    const uint sum = subgroupAdd(counts[k]);
    if (subgroupElect() && sum > 0u) atomicAdd(UintRef(extras.counters).at[k], sum);
  }
}
