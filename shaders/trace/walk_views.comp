// SPDX-License-Identifier: Apache-2.0
// Traces a band of an atlas: one ray per px of every view, by the walk.
//
// An invocation takes kPixelsPerInvocation neighbouring px of one view, so that they can share the bound
// where their rays may start. Neighbouring invocations are neighbouring *views* where the atlas has
// enough columns: between views a ray moves less in the source than between px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/color.glsl"
#include "lib/walk.glsl"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = 0) const uint kWanted = 0u;             // kWant... flags
layout(constant_id = 1) const uint kColorFormat = kColorRgba8;
layout(constant_id = 2) const uint kPixelsPerInvocation = 8u;
layout(constant_id = 3) const bool kLanesAreViews = true;
layout(constant_id = 4) const bool kColorIsScaled = false;   // colour planes of another size than depth
layout(push_constant, scalar) uniform Push { TracePush push; };

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TraceParamsRef { TraceParams value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ViewsRef { ViewParams at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef { RayRecord at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer Vec4Ref { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref { uint8_t at[]; };

// Light that is left after semitransparent surfaces and is not worth another surface.
const float kTransmittanceMin = 1.0 / 255.0;
// Cells of this level share a start bound; a region of more of them takes the bound of the whole source.
const uint kStartLevel = 5u;
const int kStartCellsMax = 16;
// Rounding of 1/Z on the way to that bound, a share of where the ray comes from: 8 ulp. Whoever starts on
// a surface would be behind it.
const float kStartMargin = 8.0 / 8388608.0;

struct Scene {
  StructureRef structure;
  vec2 size_px;
  float inv_z_near;
  float kappa_abs;
  float kappa_rel;
};

vec4 surfaceColor(Scene scene, uint layer, ivec2 cell, vec2 point) {
  if (kColorIsScaled) {
    return surfaceColorScaled(scene.structure, kColorFormat, layer, cell, point, scene.kappa_abs, scene.kappa_rel);
  }
  return surfaceColorPerFacet(scene.structure, kColorFormat, layer, cell, point);
}

// Cells that neighbouring rays pass, and the largest inv_z in them.
struct StartRegion {
  vec2 low_px;
  vec2 high_px;
  float bound;
};

StartRegion startRegion(Scene scene, vec2 low_px, vec2 high_px) {
  const ivec2 level_size = ivec2(scene.structure.value.level_width[kStartLevel - kLevelFirst],
                                 scene.structure.value.level_height[kStartLevel - kLevelFirst]);
  const ivec2 first = clamp(ivec2(floor(low_px)) >> int(kStartLevel), ivec2(0), level_size - 1);
  const ivec2 last = clamp(ivec2(floor(high_px)) >> int(kStartLevel), ivec2(0), level_size - 1);
  const ivec2 extent = last - first + 1;
  const float cell_px = float(1u << kStartLevel);
  StartRegion region = StartRegion(vec2(first) * cell_px, vec2(last + 1) * cell_px, scene.inv_z_near);
  if (extent.x * extent.y > kStartCellsMax) return region;
  region.bound = 0.0;
  for (int i = 0; i < extent.x * extent.y; ++i) {
    const uvec2 cell = uvec2(first + ivec2(i % extent.x, i / extent.x));
    region.bound = max(region.bound, nodeBox(unpackNode(loadNode(scene.structure, 0u, kStartLevel, cell))).y);
  }
  region.bound *= 1.00001;
  return region;
}

// Nothing along this ray is nearer, 1/m. A wide fan of rays clipped by the image may pass cells between
// the first and the last ray that neither of the two passes.
float startBound(Scene scene, StartRegion region, Ray ray) {
  const vec2 end = (ray.start + ray.extent).xy;
  const bool is_covered = all(greaterThanEqual(min(ray.start.xy, end), region.low_px)) &&
                          all(lessThanEqual(max(ray.start.xy, end), region.high_px));
  return is_covered ? region.bound : scene.inv_z_near;
}

// The start of a ray: as far along as nothing can be, then the column it is in.
WalkStart startOf(Scene scene, Ray ray, float bound) {
  WalkStart start;
  start.behind_count = kStateUnknown;
  start.place.t = 0.0;
  start.place.axis = kAxisNone;
  const float safe_bound = bound + kStartMargin * ray.start.z;
  if (ray.extent.z < 0.0 && ray.start.z > safe_bound) {
    start.place.t = min((safe_bound - ray.start.z) / ray.extent.z, 1.0);
  }
  const vec2 point = (ray.start + start.place.t * ray.extent).xy;
  start.place.cell = clamp(ivec2(floor(point)), ivec2(0), ivec2(scene.size_px) - 1);
  return start;
}

vec3 backgroundLight(TraceParams params) {
  return linearFromSrgb(unpackUnorm4x8(params.background_rgb).bgr);
}

// What stands behind everything that was met: the far side of a silhouette goes on, the image's border
// goes on, or the background.
vec3 fillLight(Scene scene, TraceParams params, Walk walk, Ray ray) {
  uint layer = 0u;
  ivec2 cell = walk.cell;
  bool is_known = params.outside_is_border != 0u && walk.leaves;
  if (walk.ends_behind) {
    layer = walk.has_far_side ? walk.far_layer : 0u;
    cell = walk.has_far_side ? walk.far_cell : walk.cell;
    is_known = true;
  }
  if (!is_known || loadInvZ(scene.structure, layer, cell) < 0.0) return backgroundLight(params);
  return surfaceColor(scene, layer, cell, vec2(cell) + 0.5).rgb;
}

uint classOf(Walk walk) {
  if (walk.is_hit) return walk.is_assumed ? kClassHitAssumed : kClassHit;
  if (walk.ends_behind) return kClassHidden;
  return walk.leaves ? kClassOutside : kClassEmpty;
}

Walk walkScene(Scene scene, ViewParams view, Ray ray, WalkStart start) {
  return walkRay(scene.structure, ray, start, view.inv_z_tolerance, view.eye.z, scene.kappa_abs, scene.kappa_rel);
}

// Opaque sources stop at the first surface. Others are composited front to back: each surface is walked
// on from, behind it.
vec3 lightAlong(Scene scene, TraceParams params, ViewParams view, Ray ray, Walk first) {
  vec3 light = vec3(0.0);
  float transmittance = 1.0;
  Walk walk = first;
  while (walk.is_hit && transmittance > kTransmittanceMin) {
    const vec3 point = ray.start + walk.t * ray.extent;
    const vec4 color = surfaceColor(scene, walk.layer, walk.cell, point.xy);
    light += transmittance * color.rgb;
    transmittance *= 1.0 - color.a;
    if (kColorFormat == kColorRgba8 || color.a >= 1.0 || transmittance <= kTransmittanceMin) return light;
    const WalkStart behind = WalkStart(Place(walk.t, walk.cell, kAxisNone), walk.layer + 1u);
    walk = walkScene(scene, view, ray, behind);
  }
  return light + transmittance * fillLight(scene, params, walk, ray);
}

// A ray that never sees the image continues the border next to where it goes.
Walk walkBeside(Scene scene, vec3 direction) {
  Walk walk;
  walk.is_hit = false;
  walk.is_assumed = false;
  walk.ends_behind = false;
  walk.leaves = true;
  walk.t = 1.0;
  const vec2 toward = direction.z > 0.0 ? direction.xy / direction.z : 0.5 * scene.size_px;
  walk.cell = ivec2(clamp(toward, vec2(0.0), scene.size_px - 1.0));
  walk.layer = 0u;
  walk.has_far_side = false;
  walk.far_cell = walk.cell;
  walk.far_layer = 0u;
  walk.visits = 0u;
  return walk;
}

void store(TraceParams params, uint index, vec3 light, Walk walk, Ray ray, float view_inv_z) {
  const vec3 srgb = srgbFromLinear(light);
  UintRef(params.color).at[index] = packUnorm4x8(vec4(srgb, 1.0));
  const uint ray_class = classOf(walk);
  if ((kWanted & kWantDepth) != 0u) FloatRef(params.depth).at[index] = view_inv_z;
  if ((kWanted & kWantMask) != 0u) Uint8Ref(params.mask).at[index] = uint8_t(ray_class);
  if ((kWanted & kWantLinear) != 0u) Vec4Ref(params.linear).at[index] = vec4(srgb, 1.0);
  if ((kWanted & kWantRecords) != 0u) {
    const vec3 point = ray.start + walk.t * ray.extent;
    RecordsRef(params.records).at[index] = RayRecord(point.x, point.y, point.z, ray_class, walk.layer, walk.visits);
  }
}

void main() {
  const TraceParams params = TraceParamsRef(push.params).value;
  const uint row = params.first_row + gl_WorkGroupID.y;
  const uint invocation = gl_GlobalInvocationID.x;
  const uint blocks = (params.tile_width_px + kPixelsPerInvocation - 1u) / kPixelsPerInvocation;
  uint counts[kClassCount] = uint[kClassCount](0u, 0u, 0u, 0u, 0u, 0u);

  uint column = kLanesAreViews ? invocation % params.tile_columns : invocation / blocks;
  const uint block = kLanesAreViews ? invocation / params.tile_columns : invocation % blocks;
  const uint tile_row = row < params.padding_top_px ? params.tile_rows
                                                    : (row - params.padding_top_px) / params.tile_height_px;
  bool is_used = block < blocks && column < params.tile_columns && tile_row < params.tile_rows;
  column = min(column, params.tile_columns - 1u);
  const uint tile = min(tile_row, params.tile_rows - 1u) * params.tile_columns + column;
  const ViewParams view = ViewsRef(params.views).at[tile];
  is_used = is_used && view.is_used != 0u;

  if (is_used) {
    const uint first_x = block * kPixelsPerInvocation;
    const uint count = min(kPixelsPerInvocation, params.tile_width_px - first_x);
    const float tile_y = float(row - params.padding_top_px - tile_row * params.tile_height_px) + 0.5;
    const uint first_index = gl_WorkGroupID.y * params.atlas_width_px + column * params.tile_width_px + first_x;

    Scene scene;
    scene.structure = StructureRef(params.structure);
    scene.size_px = vec2(scene.structure.value.width_px, scene.structure.value.height_px);
    MeasuredRef measured = MeasuredRef(scene.structure.value.measured);
    // A little in front of everything; never 0, it is a divisor.
    scene.inv_z_near = max(uintBitsToFloat(measured.value.inv_z_max_bits), 1e-12) * 1.0001;
    scene.kappa_abs = measured.value.kappa_abs;
    scene.kappa_rel = measured.value.kappa_rel;

    vec2 low_px = vec2(3.4e38);
    vec2 high_px = vec2(-3.4e38);
    bool all_inside = true;
    for (uint i = 0u; i < count; i += max(count - 1u, 1u)) {
      const vec3 direction = rayDirection(view, vec2(float(first_x + i) + 0.5, tile_y));
      const Ray ray = makeRay(view.eye, direction, scene.size_px, scene.inv_z_near);
      all_inside = all_inside && ray.is_inside;
      low_px = min(low_px, min(ray.start.xy, (ray.start + ray.extent).xy));
      high_px = max(high_px, max(ray.start.xy, (ray.start + ray.extent).xy));
    }
    StartRegion region = startRegion(scene, low_px, high_px);
    if (!all_inside) region.bound = scene.inv_z_near;

    for (uint i = 0u; i < count; ++i) {
      const vec3 direction = rayDirection(view, vec2(float(first_x + i) + 0.5, tile_y));
      const Ray ray = makeRay(view.eye, direction, scene.size_px, scene.inv_z_near);
      Walk walk = walkBeside(scene, direction);
      if (ray.is_inside) walk = walkScene(scene, view, ray, startOf(scene, ray, startBound(scene, region, ray)));
      const vec3 light = lightAlong(scene, params, view, ray, walk);
      const vec3 point = ray.start + walk.t * ray.extent;
      const float view_inv_z = walk.is_hit ? viewInvZ(view.eye, direction, point) : 0.0;
      store(params, first_index + i, light, walk, ray, view_inv_z);
      ++counts[classOf(walk)];
    }
  }

  for (uint i = kClassHit; i < kClassCount; ++i) {
    const uint sum = subgroupAdd(counts[i]);
    if (subgroupElect() && sum > 0u) atomicAdd(UintRef(params.counters).at[i], sum);
  }
}
