// SPDX-License-Identifier: Apache-2.0
// What comes to the px of a band by way of the surfaces that they show: rays that go on from where
// those of walk_views.comp ended, mirrored, and end in the same structure. An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kOwnConstants + 0u) const uint kColorFormat = kColorRgba8;
layout(constant_id = kOwnConstants + 1u) const bool kColorIsScaled = false;
layout(constant_id = kOwnConstants + 2u) const uint kRays = kRaysOfPinholes;
const bool kRaysArePlain = false;
// Rays begin behind the layers in front of their surface.
const bool kSeesThrough = true;
const bool kMeetsBacks = true;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

layout(set = 0, binding = kBindingViews, scalar) readonly buffer Views {
  ViewParams views[];
};
layout(set = 0, binding = kBindingExtras, scalar) uniform Extras {
  TraceExtras extras;
};
layout(set = 0, binding = kBindingReflection, scalar) uniform Settings {
  ReflectionSettings settings;
};
layout(set = 0, binding = kBindingReflected, scalar) writeonly buffer ReflectedBand {
  ReflectedLight reflected_band[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RecordsRef {
  RayRecord at[];
};

#include "lib/ggx.glsl"
#include "lib/mirror.glsl"
#include "lib/ray_light.glsl"
#include "lib/ray_source.glsl"
#include "lib/reflection_counts.glsl"

// As rough as that, a surface is a mirror: what it spreads is less than px show.
const float kMirrorRoughness = 0.02;
// Blur hides errors: so much of its width.
const float kBlurShare = 0.125;
// Steps of the depth samples, and sigmas of their noise, by which a surface stands out from itself.
const float kStepsOfSurface = 1.0;
const float kSigmasOfSurface = 4.0;

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

vec3 linearOfBlend(vec3 blend) {
  if (holdsCodes(kColorFormat)) return linearFromSrgb(blend / 255.0);
  return kColorFormat == kColorRgb16 ? pow(blend, vec3(2.4)) : blend;
}

// A ray on its way from surface to surface.
struct Path {
  vec3 direction;  // unit length
  vec3 eye;        // where it seems to come from, behind all mirrors so far; m
  vec3 share;      // of the light that it finds
  bool is_bent;
};

// Off a mirror, by its own normal or by that of a microfacet. Who would go on below the surface
// itself goes along it.
void turn(Mirror mirror, Spot spot, Pinhole pinhole, vec2 place, inout Path path) {
  const float alpha = mirror.roughness * mirror.roughness;
  const mat3 basis = basisAround(mirror.normal);
  const vec3 towards = -path.direction * basis;
  const bool is_rough = mirror.roughness > kMirrorRoughness && towards.z > 1e-4;
  const vec3 halfway =
      is_rough ? basis * visibleNormal(towards, alpha, place) : mirror.normal;
  vec3 direction = reflect(path.direction, halfway);
  const float above = dot(direction, mirror.facet_normal);
  path.is_bent = path.is_bent || above <= 0.0;
  direction = normalize(direction + max(-above, 0.0) * mirror.facet_normal);
  path.share *= fresnel(mirror.light, dot(direction, halfway));
  const float cosine_out = max(dot(direction, mirror.normal), 1e-4);
  if (is_rough) path.share *= unshadowed(cosine_out, max(towards.z, 1e-4), alpha);
  path.direction = direction;
  const vec3 to_eye = path.eye - metresOf(pinhole, spot.point);
  path.eye -= 2.0 * dot(to_eye, mirror.normal) * mirror.normal;
}

// By how much what is one with a surface may stand out from it.
float surfaceError(Scene scene, Pinhole pinhole, Spot spot, vec3 eye, float moved_px) {
  const float cross = length(cross(metricPoint(pinhole, vec3(spot.point.xy, 1.0)), eye));
  const float kappa = connectionTolerance(scene.kappa.x, scene.kappa.y, spot.point.z);
  const float seen = min(moved_px / max(cross, 1e-30), 0.5 * kappa);
  const float measured = max(kStepsOfSurface * measured_head.depth_step,
                             kSigmasOfSurface * measured_head.noise_sigma);
  return seen + measured + kRounding * scene.inv_z_near;
}

// How much a surface beyond another counts: the longer a ray went on unseen, the likelier it has
// met what nobody knows of.
float certainty(Pinhole pinhole, Spot from, Ray ray, float passed_t, float hit_t) {
  const vec3 passed = ray.start + passed_t * ray.extent;
  const vec3 hit = ray.start + hit_t * ray.extent;
  if (passed.z <= 0.0 || hit.z <= 0.0) return 0.0;
  const float unseen_m = distance(metresOf(pinhole, hit), metresOf(pinhole, passed));
  return exp(-unseen_m * from.point.z);
}

// What a reflected ray found.
struct Found {
  vec3 light;
  uint ending;        // kReflection...
  bool meets_surface;
  Spot spot;          // then
  float certainty;    // of light that does not come from the environment
};

Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected) {
  const Ray ray = reflected.ray;
  Walk walk = walkBeside(reflected.start);
  if (ray.t_begin < ray.t_end) {
    walk = walkRay(scene, ray, reflected.start, reflected.inv_z_tolerance, reflected.eye_z);
  }
  const Light light = opaqueLight(scene, ray, walk);
  const bool ends_behind = !walk.is_hit && walk.ends_behind && light.is_known;
  // The far side goes on as far back as it was seen.
  const uvec2 far_facet = loadFacet(scene.layers, walk.far_layer, scene.extent, walk.far_cell);
  const float far_t = ray.extent.z < 0.0
                          ? (max(facetInvZ(far_facet), 0.0) - ray.start.z) / ray.extent.z
                          : ray.t_end;
  const float end_t = ends_behind ? clamp(far_t, min(walk.passed_t, ray.t_end), ray.t_end) : walk.t;
  const bool is_unseen = walk.is_assumed || walk.is_back || ends_behind;
  Found found;
  found.meets_surface = walk.is_hit && !walk.is_back;
  found.ending = walk.is_back                      ? kReflectionBack
                 : walk.is_assumed || ends_behind ? kReflectionAssumed
                 : walk.is_hit                    ? kReflectionHit
                                                  : kReflectionEnvironment;
  found.certainty = is_unseen ? certainty(pinhole, from, ray, walk.passed_t, end_t)
                              : float(walk.is_hit);
  found.light = mix(settings.environment, linearOfBlend(light.color.rgb), found.certainty);
  const vec3 point = ray.start + end_t * ray.extent;
  found.spot = Spot(point, walk.cell, walk.layer);
  return found;
}

// All rays of a px.
struct Gathered {
  vec3 light;        // without what the first surface takes of it
  vec3 reflectance;  // what that takes
  float distance_m;
};

Gathered gather(Scene scene, Pinhole pinhole, Spot first, Mirror first_mirror, Path first_path,
                float px_angle, uvec2 px, inout uvec3 counts) {
  const uint count = first_mirror.roughness > kMirrorRoughness ? settings.sample_count : 1u;
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0);
  uint i = 0u;
  uint bounce = 0u;
  Spot spot = first;
  Mirror mirror = first_mirror;
  Path path = first_path;
  vec3 light = vec3(0.0);
  vec3 own_share = vec3(1.0);
  for (;;) {
    if (isNever(scene, 11u)) break;
    turn(mirror, spot, pinhole, samplePlace(i * settings.bounce_count + bounce,
                                            count * settings.bounce_count, px), path);
    const bool is_first = bounce == 0u;
    own_share = is_first ? path.share : own_share;
    path.share = is_first ? vec3(1.0) : path.share;
    const float blur = kBlurShare * mirror.roughness * mirror.roughness;
    const float moved_px = settings.tolerance_px * px_angle + blur;
    const float error = surfaceError(scene, pinhole, spot, path.eye, moved_px);
    const Reflected reflected =
        reflectedRay(scene, pinhole, spot, path.direction, path.eye, moved_px, error);
    const Found found = follow(scene, pinhole, spot, reflected);
    light += path.share * found.light;
    countReflection(counts, found.ending, path.is_bent);
    const float way_m = found.spot.point.z > 0.0
                            ? distance(metresOf(pinhole, found.spot.point),
                                       metresOf(pinhole, spot.point))
                            : 65504.0;
    sum.distance_m += is_first ? min(way_m, 65504.0) / float(count) : 0.0;
    ++bounce;
    bool goes_on = found.meets_surface && bounce < settings.bounce_count;
    if (goes_on) {
      spot = spotAt(scene, found.spot.point);
      mirror = mirrorAt(scene, pinhole, settings.surfaces, spot);
      goes_on = any(greaterThan(mirror.light, vec3(0.0)));
      path.share *= found.certainty;
      path.is_bent = false;
    }
    if (!goes_on) {
      sum.light += own_share * light / float(count);
      sum.reflectance += own_share / float(count);
      ++i;
      bounce = 0u;
      spot = first;
      mirror = first_mirror;
      path = first_path;
      light = vec3(0.0);
    }
    if (!goes_on && i >= count) break;
  }
  sum.light /= max(sum.reflectance, vec3(1e-6));
  return sum;
}

ReflectedLight packed(Gathered gathered, Mirror mirror, Spot spot) {
  const vec3 light = min(gathered.light, vec3(65504.0));
  const vec3 on = mirror.normal /
                  (abs(mirror.normal.x) + abs(mirror.normal.y) + abs(mirror.normal.z));
  return ReflectedLight(uvec2(packHalf2x16(light.rg),
                              packHalf2x16(vec2(light.b, gathered.distance_m))),
                        packUnorm4x8(vec4(gathered.reflectance, mirror.roughness)),
                        (packSnorm4x8(vec4(on.xy, 0.0, 0.0)) & 0xffffu) |
                            (floatBitsToUint(spot.point.z) & 0xffff0000u));
}

ReflectedLight reflectedLight(Scene scene, uint index, uvec2 tile_px, ViewParams view,
                              inout uvec3 counts) {
  const ReflectedLight none = ReflectedLight(uvec2(0u), 0u, 0u);
  const RayRecord record = RecordsRef(extras.records).at[index];
  const Aim aim = aimOf(vec2(tile_px) + 0.5);
  const bool is_hit = record.ray_class == kClassHit || record.ray_class == kClassHitAssumed;
  const bool is_shown = is_hit && aim.is_used && record.inv_z > 0.0 &&
                        (view.shows & kShowsDepth) == 0u;
  if (!is_shown) return none;
  if (kRays != kRaysOfPinholes) view = viewFrom(view, extras.eye_axes, aim.eye_m);
  const Pinhole pinhole = Pinhole(extras.focal_px, extras.principal_px);
  const Spot spot = spotAt(scene, vec3(record.x_px, record.y_px, record.inv_z));
  const Mirror mirror = mirrorAt(scene, pinhole, settings.surfaces, spot);
  if (all(lessThanEqual(mirror.light, vec3(0.0)))) return none;
  const vec3 eye = metricPoint(pinhole, view.eye);
  Path path;
  path.direction = normalize(metresOf(pinhole, spot.point) - eye);
  path.eye = eye;
  path.share = vec3(1.0);
  path.is_bent = false;
  // Of a px of the view, as what it sees stands on its axis.
  const float px_angle = length(metricPoint(pinhole, view.direction_dx));
  return packed(gather(scene, pinhole, spot, mirror, path, px_angle, tile_px, counts), mirror,
                spot);
}

void main() {
  const uvec2 tile_size = unpackSize(push.tile_size_px);
  const uvec2 tile_grid = unpackSize(push.tile_grid);
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint x = gl_GlobalInvocationID.x;
  const uint column = x / tile_size.x;
  const uint tile_row =
      row < push.padding_top_px ? tile_grid.y : (row - push.padding_top_px) / tile_size.y;
  const bool exists = column < tile_grid.x && tile_row < tile_grid.y;
  const uint index = gl_WorkGroupID.y * push.atlas_width_px + x;
  uvec3 counts = uvec3(0u);
  ReflectedLight light = ReflectedLight(uvec2(0u), 0u, 0u);
  if (exists) {
    const ViewParams view = views[tile_row * tile_grid.x + column];
    if (view.is_used != 0u) {
      Scene scene;
      scene.layers = push.layers;
      scene.layer_count = push.layer_count;
      scene.extent = makeExtent(ivec2(unpackSize(push.source_size_px)));
      scene.inv_z_near =
          max(uintBitsToFloat(measured_head.inv_z_max_bits), kInvZNearMin) * kInvZNearMargin;
      scene.fills_border = false;
      scene.kappa = vec2(measured_head.kappa_abs, measured_head.kappa_rel);
      const uvec2 tile_px = uvec2(x - column * tile_size.x,
                                  row - push.padding_top_px - tile_row * tile_size.y);
      light = reflectedLight(scene, index, tile_px, view, counts);
    }
  }
  if (x < push.atlas_width_px) reflected_band[index] = light;
  addReflectionCounts(counts, UintRef(extras.counters),
                      gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y);
}
