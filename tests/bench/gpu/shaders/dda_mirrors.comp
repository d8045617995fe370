// SPDX-License-Identifier: Apache-2.0
// McGuire & Mara, "Efficient GPU Screen-Space Ray Tracing" (JCGT 2014), of reflected rays: straight
// in (x, y, 1/Z), looked at in the middle of every stride-th px along the axis that they go along
// most, and met by samples that are so many metres thick. All but the search is viewloom's own: the
// mirrors, the rays that they send on, the colour of what these meet. Where nothing is met there is
// the environment's light.
//
// Beyond the paper: where a stride meets something its px are looked at one by one, and between two
// px of one surface the ray ends where it passes the line through both samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "rival_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  TracePush push;
  MarchKnobs knobs;
};

#include "lib/mirrors/mirrored_px.glsl"
#include "lib/mirrors/settings.glsl"

// Where in the image a ray is looked at.
struct March {
  float px_t;     // t from the middle of a px to that of the next
  float first_t;  // of the first middle of a px beyond the ray's start
};

March marchOf(Ray ray) {
  const bool along_x = ray.pace.x <= ray.pace.y;
  const float start_px = along_x ? ray.start.x : ray.start.y;
  const float extent_px = along_x ? ray.extent.x : ray.extent.y;
  const float px_t = along_x ? ray.pace.x : ray.pace.y;
  const float from_px = start_px + ray.t_begin * extent_px;
  const float middle_px =
      extent_px < 0.0 ? ceil(from_px - 0.5) - 0.5 : floor(from_px + 0.5) + 0.5;
  return March(px_t, abs(middle_px - start_px) * px_t);
}

ivec2 cellAt(Scene scene, vec3 point) {
  return ivec2(clamp(point.xy, vec2(0.0), vec2(scene.extent.size_px - 1)));
}

float sampleAt(Scene scene, uint layer, ivec2 cell) {
  const uvec2 size_px = uvec2(scene.extent.size_px);
  const uint index = invZIndex(invZPitch(size_px.x), uint(cell.x), cell.y);
  return texelFetch(inv_z_texels, int(layer * invZArea(size_px.x, size_px.y) + index)).x;
}

struct Met {
  bool is_hit;
  float t;
  uint layer;
};

// From a px that was met back to where the ray passed the line between its sample and the one
// before, if both are one surface.
float passedAt(Scene scene, Ray ray, Met met, float px_t) {
  const float before_t = met.t - px_t;
  const vec3 before = ray.start + before_t * ray.extent;
  const vec3 at = ray.start + met.t * ray.extent;
  const float inv_z = sampleAt(scene, met.layer, cellAt(scene, at));
  const float inv_z_before = sampleAt(scene, met.layer, cellAt(scene, before));
  const float kappa =
      stepAt(scene.kappa, max(inv_z, inv_z_before));
  const float front_before = before.z - inv_z_before;
  const float front_at = at.z - inv_z;
  const bool passes = before_t >= ray.t_begin && abs(inv_z - inv_z_before) <= kappa &&
                      front_before > 0.0 && front_at <= 0.0;
  return passes ? before_t + px_t * (front_before / (front_before - front_at)) : met.t;
}

// The nearest layer of a px whose sample, as thick as it is, the ray passes between two places.
uint layerMet(Scene scene, ivec2 cell, float inv_z_from, float inv_z_to) {
  const float nearest = max(inv_z_from, inv_z_to);
  const float furthest = min(inv_z_from, inv_z_to);
  uint layer = 0u;
  uint met = kNoLayer;
  for (;;) {
    if (isNever(scene, 13u)) break;
    const float inv_z = sampleAt(scene, layer, cell);
    const float behind = inv_z / (1.0 + knobs.thickness_m * inv_z);
    if (met == kNoLayer && inv_z >= furthest && behind <= nearest) met = layer;
    ++layer;
    if (layer >= (knobs.layer_stride >> kMarchLayerShift)) break;
  }
  return met;
}

Met march(Scene scene, Ray ray) {
  const March plan = marchOf(ray);
  const uint stride_px = knobs.layer_stride & ((1u << kMarchLayerShift) - 1u);
  const float stride_t = float(stride_px) * plan.px_t;
  Met met = Met(false, plan.first_t, 0u);
  float last_t = ray.t_begin;
  float fine_until_t = -1.0;  // px by px up to there
  uint count = 0u;
  for (;;) {
    if (isNever(scene, 12u)) break;
    if (met.t >= ray.t_end || count >= knobs.step_count_max) break;
    const vec3 point = ray.start + met.t * ray.extent;
    const uint layer =
        layerMet(scene, cellAt(scene, point), ray.start.z + last_t * ray.extent.z, point.z);
    const bool is_fine = stride_px == 1u || met.t <= fine_until_t;
    met.is_hit = layer != kNoLayer && is_fine;
    met.layer = met.is_hit ? layer : 0u;
    if (met.is_hit) break;
    const bool begins_fine = layer != kNoLayer;
    fine_until_t = begins_fine ? met.t + 0.5 * plan.px_t : fine_until_t;
    const bool goes_fine = begins_fine || met.t + plan.px_t <= fine_until_t;
    const float back_t = last_t < plan.first_t ? plan.first_t - plan.px_t : last_t;
    const float from_t = begins_fine ? back_t : met.t;
    last_t = begins_fine ? last_t : met.t;
    met.t = from_t + (goes_fine ? plan.px_t : stride_t);
    ++count;
  }
  if (met.is_hit) met.t = passedAt(scene, ray, met, plan.px_t);
  return met;
}

Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected) {
  const Ray ray = reflected.ray;
  Walk walk = walkBeside(WalkStart(ray.t_begin, from.cell, from.layer));
  if (ray.t_begin < ray.t_end) {
    const Met met = march(scene, ray);
    walk.is_hit = met.is_hit;
    walk.t = met.t;
    walk.layer = met.layer;
    walk.cell = cellAt(scene, ray.start + met.t * ray.extent);
  }
  const Light light = opaqueLight(scene, ray, walk);
  Found found;
  found.meets_surface = walk.is_hit && light.is_known;
  found.ending = found.meets_surface ? kReflectionHit : kReflectionEnvironment;
  found.certainty = float(found.meets_surface);
  found.light = found.meets_surface ? linearOfBlend(light.color.rgb, scene.color.format)
                                    : settings.environment;
  found.spot = Spot(ray.start + walk.t * ray.extent, walk.cell, walk.layer);
  return found;
}

void main() {
  reflectPx(push, ReflectRules(kRaysOfPinholes, false, kColorRgba8, false));
}
