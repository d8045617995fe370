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
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kOwnConstants + 0u) const uint kWanted = 0u;  // kWant... flags
layout(constant_id = kOwnConstants + 1u) const uint kColorFormat = kColorRgba8;
layout(constant_id = kOwnConstants + 2u) const uint kPixelsPerInvocation = 8u;
layout(constant_id = kOwnConstants + 3u) const bool kLanesAreViews = true;
// Colour planes of another size than depth
layout(constant_id = kOwnConstants + 4u) const bool kColorIsScaled = false;
// Rays of the whole atlas as makePlainRay takes them; else as makeAnyRay does.
layout(constant_id = kOwnConstants + 5u) const bool kRaysArePlain = true;
// All eyes are in the source's plane, or as good as that (server/trace/trace_job.h).
layout(constant_id = kOwnConstants + 6u) const bool kEyesInPlane = true;
const bool kSeesThrough = kColorFormat == kColorRgba16f;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

layout(set = 0, binding = kBindingViews, scalar) readonly buffer Views {
  ViewParams views[];
};
layout(set = 0, binding = kBindingExtras, scalar) uniform Extras {
  TraceExtras extras;
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef {
  RayRecord at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref {
  uint8_t at[];
};

#include "lib/class_counts.glsl"
#include "lib/color.glsl"
#include "lib/edge_blend.glsl"
#include "lib/ray_start.glsl"
#include "lib/walk.glsl"

// Light that is left after semitransparent surfaces and is not worth another surface.
const float kTransmittanceMin = 1.0 / 255.0;

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

// `clean`: of lib/color.glsl, where colour has the size of depth.
vec4 surfaceColor(Scene scene, uint layer, ivec2 cell, uint links, vec2 point, vec2 clean) {
  if (kColorIsScaled) {
    const ColorSizes sizes = ColorSizes(extras.color_size_px, extras.color_stride);
    return surfaceColorScaled(scene.layers, push.color, scene.layer_count, scene.extent, sizes,
                              kColorFormat, layer, cell, point, scene.kappa);
  }
  return surfaceColorPerFacet(scene.layers, push.color, scene.extent, kColorFormat, layer, cell,
                              links, point, clean);
}

uint classOf(Walk walk) {
  const uint hit = walk.is_assumed ? kClassHitAssumed : kClassHit;
  const uint no_hit = walk.ends_behind ? kClassHidden : walk.leaves ? kClassOutside : kClassEmpty;
  return walk.is_hit ? hit : no_hit;
}

// A ray that never sees the image continues the border next to where it goes.
Walk walkBeside(WalkStart start) {
  return Walk(false, false, false, true, 1.0, start.cell, 0u, false, start.cell, 0u, 0.0, kAxisNone,
              0.0, 0u);
}

// Codes 0..255 of a blend of texels.
vec3 codesOfBlend(vec3 blend) {
  if (kColorFormat == kColorRgba8) return blend;
  return kColorFormat == kColorRgb11 ? codesFromRoots(blend) : codesFromLinear(blend);
}

// The background as texels are held.
vec3 blendOfBackground() {
  const vec3 codes = vec3(uvec3(push.fill, push.fill >> 8, push.fill >> 16) & 255u);
  if (kColorFormat == kColorRgba8) return codes;
  const vec3 light = linearFromSrgb(codes / 255.0);
  return kColorFormat == kColorRgb11 ? rootsFromLinear(light) : light;
}

// What a px shows; if nothing is known, the background. In what texels hold (lib/color.glsl).
struct Light {
  vec4 color;  // premultiplied
  bool is_known;
};

// A view moves what is nearest by the extent of its rays: from the source's own place the source is
// seen as it is, from a px beside it none of the samples that may be mixed. By axis.
vec2 cleanShare(Ray ray) {
  return min(abs(ray.extent.xy), vec2(1.0));
}

// Where the far side of a silhouette is looked up: in the middle of its column, towards the near side
// as far as the ray was up the step, if that is not deep.
vec2 farPoint(Ray ray, Walk walk) {
  const vec2 passed = (ray.start + walk.far_t * ray.extent).xy;
  const vec2 middle = vec2(walk.far_cell) + 0.5;
  const vec2 along = middle + walk.far_share * sign(ray.extent.xy);
  return walk.far_axis == kAxisX   ? vec2(along.x, passed.y)
         : walk.far_axis == kAxisY ? vec2(passed.x, along.y)
                                   : middle;
}

// Opaque sources end at the first surface. Without one, the far side of the silhouette the ray
// passed behind, or the image's border, goes on; else there is nothing.
Light opaqueLight(Scene scene, Ray ray, Walk walk) {
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
  const bool is_known = walk.is_hit || walk.ends_behind || is_border;
  const vec4 color = surfaceColor(scene, layer, cell, links, at, cleanShare(ray));
  return Light(color, is_known && (own_links & kFacetExists) != 0u);
}

// A walk that went through a surface and ended behind it passed no silhouette. Its far side is the
// furthest surface at distances that double, both ways along the ray: soft edges may be wide.
const uint kFarSideProbes = 8u;  // up to 128 px away

void findFarSide(Scene scene, Ray ray, WalkStart behind, inout Walk walk) {
  const bool has_none = !walk.is_hit && walk.ends_behind && !walk.has_far_side;
  const bool is_sought = has_none && behind.behind_count > 0u;
  const uint layer = is_sought ? behind.behind_count - 1u : 0u;
  const vec2 along = ray.extent.xy * min(ray.pace.x, ray.pace.y);
  const vec2 from = vec2(behind.cell) + 0.5;
  float furthest = scene.inv_z_near;
  uint probe = 0u;
  for (;;) {
    if (isNever(scene, 6u)) break;
    for (int side = -1; side <= 1; side += 2) {
      const ivec2 cell = ivec2(floor(from + float(side * (1 << int(probe))) * along));
      const ivec2 inside = clamp(cell, ivec2(0), scene.extent.size_px - 1);
      const float inv_z = facetInvZ(loadFacet(scene.layers, layer, scene.extent, inside));
      const bool is_further = is_sought && inv_z >= 0.0 && inv_z < furthest;
      walk.far_cell = is_further ? inside : walk.far_cell;
      walk.far_layer = is_further ? layer : walk.far_layer;
      walk.has_far_side = is_further || walk.has_far_side;
      walk.far_axis = is_further ? kAxisNone : walk.far_axis;
      walk.far_share = is_further ? 0.0 : walk.far_share;
      furthest = is_further ? inv_z : furthest;
    }
    ++probe;
    if (!is_sought || probe == kFarSideProbes) break;
  }
}

// Semitransparent ones are composited front to back: each surface is walked on from, behind it.
Light layeredLight(Scene scene, ViewParams view, Ray ray, Walk first) {
  vec3 light = vec3(0.0);
  const vec3 background = blendOfBackground();
  float transmittance = 1.0;
  Walk walk = first;
  WalkStart behind = WalkStart(0.0, first.cell, 0u);
  for (;;) {
    findFarSide(scene, ray, behind, walk);
    const Light seen = opaqueLight(scene, ray, walk);
    const vec4 last = vec4(seen.is_known ? seen.color.rgb : background, 1.0);
    const vec4 color = walk.is_hit ? seen.color : last;
    light += transmittance * color.rgb;
    transmittance *= 1.0 - color.a;
    if (!walk.is_hit || transmittance <= kTransmittanceMin) return Light(vec4(light, 1.0), true);
    behind = WalkStart(walk.t, walk.cell, walk.layer + 1u);
    walk = walkRay(scene, ray, behind, view.inv_z_tolerance, view.eye.z);
  }
}

void storeColor(uint index, Seen seen) {
  const vec3 codes = codesOfBlend(seen.color);
  band[index] = packCodes(codes);
  if ((kWanted & kWantLinear) != 0u) {
    Vec4Ref(extras.linear).at[index] = vec4(clamp(codes / 255.0, 0.0, 1.0), 1.0);
  }
}

void storeOthers(uint index, Walk walk, Ray ray, vec3 eye, vec3 direction) {
  if (kWanted == 0u) return;
  const vec3 point = ray.start + walk.t * ray.extent;
  const uint ray_class = classOf(walk);
  if ((kWanted & kWantDepth) != 0u) {
    FloatRef(extras.depth).at[index] = walk.is_hit ? viewInvZ(eye, direction, point) : 0.0;
  }
  if ((kWanted & kWantMask) != 0u) Uint8Ref(extras.mask).at[index] = uint8_t(ray_class);
  if ((kWanted & kWantRecords) != 0u) {
    RecordsRef(extras.records).at[index] =
        RayRecord(point.x, point.y, point.z, ray_class, walk.layer, walk.visits);
  }
}

Seen seenOf(Ray ray, Walk walk, Light light, vec3 background) {
  const vec2 px_per_inv_z = ray.extent.xy / (ray.extent.z == 0.0 ? 1.0 : ray.extent.z);
  Seen seen;
  seen.color = light.is_known ? light.color.rgb : background;
  seen.inv_z = walk.is_hit ? ray.start.z + walk.t * ray.extent.z : kNoSurface;
  seen.cell = walk.cell;
  seen.layer = walk.layer;
  seen.at_sky = ray.start.xy - ray.start.z * px_per_inv_z;
  seen.px_per_inv_z = px_per_inv_z;
  seen.clean = cleanShare(ray).x;
  return seen;
}

// A run of px of one row of one view, and where it lies in the band. Between two runs of a row each
// is traced with one px more, which the other stores.
struct Run {
  uint first_x;
  uint count;
  uint lead;   // px of another run at the beginning, 0 or 1
  uint trail;  // and at the end
  float tile_y;
  uint first_index;
};

// The bound where the rays of a run may start. Rays between two plain ones are plain, and pass no
// cell outside the rectangle around those.
float boundOfRun(Scene scene, ViewParams view, vec3 near_eye, Run run) {
  const vec2 size_px = vec2(scene.extent.size_px);
  const vec3 first = rayDirection(view, vec2(float(run.first_x) + 0.5, run.tile_y));
  const vec3 last = first + float(run.count - 1u) * view.direction_dx;
  if (!kRaysArePlain && !(isPlainRay(near_eye, first) && isPlainRay(near_eye, last))) {
    return scene.inv_z_near;
  }
  const vec2 first_end = first.xy / first.z;
  const vec2 last_end = last.xy / last.z;
  const vec2 first_start = first_end * (1.0 - near_eye.z) + near_eye.xy;
  const vec2 last_start = last_end * (1.0 - near_eye.z) + near_eye.xy;
  const vec2 low_px = min(min(first_start, last_start), min(first_end, last_end));
  const vec2 high_px = max(max(first_start, last_start), max(first_end, last_end));
  return startBound(scene, low_px, high_px);
}

void traceRun(Scene scene, ViewParams view, Run run, inout uvec3 counts) {
  const vec3 near_eye = view.eye * scene.inv_z_near;
  const float bound = boundOfRun(scene, view, near_eye, run);
  const vec3 background = blendOfBackground();
  // A px is stored when the next one is known, and the edge between them.
  Seen before;
  vec3 own_before = vec3(0.0);
  uint i = 0u;
  for (;;) {
    if (isNever(scene, 5u)) break;
    const vec3 direction = rayDirection(view, vec2(float(run.first_x + i) + 0.5, run.tile_y));
    const vec2 size_px = vec2(scene.extent.size_px);
    const Ray ray = kRaysArePlain ? makePlainRay(near_eye, direction, size_px, scene.inv_z_near)
                                  : makeAnyRay(near_eye, direction, size_px, scene.inv_z_near);
    const WalkStart start = startOf(scene, ray, bound);
    Walk walk = walkBeside(start);
    if (ray.t_begin < ray.t_end)
      walk = walkRay(scene, ray, start, view.inv_z_tolerance, view.eye.z);
    const Light light =
        kSeesThrough ? layeredLight(scene, view, ray, walk) : opaqueLight(scene, ray, walk);
    Seen seen = seenOf(ray, walk, light, background);
    const vec3 own = seen.color;
    if (i > 0u) blendAcross(scene, before, seen, own_before, own);
    if (i > run.lead) storeColor(run.first_index + i - 1u, before);
    if (i >= run.lead && i + run.trail < run.count) {
      storeOthers(run.first_index + i, walk, ray, view.eye, direction);
      count(counts, classOf(walk));
    }
    before = seen;
    own_before = own;
    ++i;
    if (i == run.count) break;
  }
  if (run.trail == 0u) storeColor(run.first_index + i - 1u, before);
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
  ViewParams view = views[tile];

  uvec3 counts = uvec3(0u);
  if (kEyesInPlane) view.eye.z = 0.0;
  if (exists && view.is_used != 0u) {
    Scene scene;
    scene.layers = push.layers;
    scene.layer_count = push.layer_count;
    scene.extent = makeExtent(ivec2(unpackSize(push.source_size_px)));
    // A little in front of everything; never 0, it is a divisor.
    scene.inv_z_near =
        max(uintBitsToFloat(measured_head.inv_z_max_bits), kInvZNearMin) * kInvZNearMargin;
    scene.fills_border = (push.fill & kFillBorder) != 0u;
    scene.kappa = vec2(measured_head.kappa_abs, measured_head.kappa_rel);
    Run run;
    const uint first_x = run_in_tile * kPixelsPerInvocation;
    run.lead = min(first_x, 1u);
    run.trail = first_x + kPixelsPerInvocation < tile_size.x ? 1u : 0u;
    run.first_x = first_x - run.lead;
    run.count = min(first_x + kPixelsPerInvocation, tile_size.x) + run.trail - run.first_x;
    run.tile_y = float(row - push.padding_top_px - tile_row * tile_size.y) + 0.5;
    run.first_index = gl_WorkGroupID.y * push.atlas_width_px + column * tile_size.x + run.first_x;
    traceRun(scene, view, run, counts);
  }
  // One atomic instruction for all classes, a lane each.
  const uvec3 sums = subgroupAdd(counts);
  const uint counter_set = gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y;
  uint ray_class = kClassHit + gl_SubgroupInvocationID;
  do {
    const uint sum = ray_class < kClassCount ? countOf(sums, ray_class) : 0u;
    const uint counter = counter_set * kCounterStride + ray_class;
    if (sum > 0u) atomicAdd(UintRef(extras.counters).at[counter], sum);
    ray_class += gl_SubgroupSize;
  } while (ray_class < kClassCount);
}
