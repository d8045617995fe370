// SPDX-License-Identifier: Apache-2.0
// Reflected light of the pixels of a band, by the surfaces of one source: an invocation a px.
#ifndef VIEWLOOM_LIB_MIRRORS_MIRRORED_PX_GLSL_
#define VIEWLOOM_LIB_MIRRORS_MIRRORED_PX_GLSL_

#include "lib/memory.glsl"
#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"

layout(set = 0, binding = kBindingReflected, scalar) writeonly buffer ReflectedBand {
  ReflectedLight reflected_band[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RecordsRef {
  RayRecord at[];
};

#include "lib/mirrors/albedo.glsl"
#include "lib/mirrors/settings.glsl"
#include "lib/mirrors/mirrored_path.glsl"
#include "lib/rays/extras.glsl"
#include "lib/rays/views.glsl"
#include "lib/walk/pushed_scene.glsl"
#include "lib/lens/px_view.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/mirrors/reflected_light.glsl"
#include "lib/mirrors/reflection_counts.glsl"
#include "lib/rays/tile_px.glsl"

vec3 linearOfBlend(vec3 blend, uint color_format) {
  if (holdsCodes(color_format)) return linearFromSrgb(blend / 255.0);
  return color_format == kColorRgb16 ? pow(blend, vec3(2.4)) : blend;
}

// Constants of a kernel that reflects.
struct ReflectRules {
  uint rays;  // of the px: kRaysOf...
  bool through_lens;
  uint color_format;
  bool color_is_scaled;
};

// Result of a reflected ray.
struct Found {
  vec3 light;
  uint ending;        // kReflection...
  bool meets_surface;
  Spot spot;          // then
  float certainty;    // of light that does not come from the environment
};

// The hit of a reflected ray. A function of each kernel: this is what they differ in.
Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected);

// All rays of a px.
struct Gathered {
  vec3 light_sum;    // of what they find, what the first surface takes
  vec3 share_sum;    // what it takes of each
  uint count;
  vec3 reflectance;  // what it takes of all light
  float closeness;   // 1/m: of what they find to the surface, the mean
};

Gathered gather(Scene scene, Pinhole pinhole, Spot first, Mirror first_mirror, Path first_path,
                float px_angle, uvec2 px, inout uvec3 counts) {
  const float cosine = cosineTowards(first_mirror, first_path);
  const bool is_rough = isRough(first_mirror, cosine);
  const uint count = is_rough ? settings.sample_count : 1u;
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), count, vec3(0.0), 0.0);
  const float moved_px = settings.tolerance_px * px_angle;
  uint i = 0u;
  uint bounce = 0u;
  Spot spot = first;
  Mirror mirror = first_mirror;
  Path path = first_path;
  vec3 light = vec3(0.0);
  vec3 own_share = vec3(1.0);
  for (;;) {
    if (isNever(scene, 11u)) break;
    const vec2 place = samplePlace(i, count, bounce, px, extras.sample_index);
    turn(mirror, spot, pinhole, place, path);
    const bool is_first = bounce == 0u;
    own_share = is_first ? path.share : own_share;
    path.share = is_first ? vec3(1.0) : path.share;
    const float error = surfaceError(scene, pinhole, spot, path.eye, moved_px);
    const Reflected reflected =
        reflectedRay(scene, pinhole, startBefore(spot, error), path.direction, path.eye, moved_px);
    const Found found = follow(scene, pinhole, spot, reflected);
    light += path.share * found.light;
    countReflection(counts, found.ending, path.is_bent);
    const float way_m = found.spot.point.z > 0.0
                            ? distance(metresOf(pinhole, found.spot.point),
                                       metresOf(pinhole, spot.point))
                            : kHalfMax;
    sum.closeness += is_first ? closenessOf(way_m) / float(count) : 0.0;
    ++bounce;
    bool goes_on = found.meets_surface && bounce < settings.bounce_count;
    if (goes_on) {
      spot = spotAt(scene, found.spot.point);
      mirror = mirrorAt(scene, pinhole, settings.surfaces, normalAxes(), spot);
      goes_on = any(greaterThan(mirror.light, vec3(0.0)));
      path.share *= found.certainty;
      path.is_bent = false;
    }
    if (!goes_on) {
      sum.light_sum += own_share * light;
      sum.share_sum += own_share;
      ++i;
      bounce = 0u;
      spot = first;
      mirror = first_mirror;
      path = first_path;
      light = vec3(0.0);
    }
    if (!goes_on && i >= count) break;
  }
  // The shares of few rays have more noise than the light that they find.
  sum.reflectance = is_rough ? albedoOf(first_mirror, cosine) : sum.share_sum;
  return sum;
}

ReflectedLight reflectedLight(Scene scene, ReflectRules rules, uint index, uvec2 tile_px,
                              ViewParams view, inout uvec3 counts) {
  const RayRecord record = RecordsRef(extras.records).at[index];
  const Aim aim = aimOf(vec2(tile_px) + 0.5, rules.rays);
  const bool is_hit = record.ray_class == kClassHit || record.ray_class == kClassHitAssumed;
  const bool is_shown = is_hit && aim.is_used && record.inv_z > 0.0 &&
                        (view.shows & kShowsDepth) == 0u;
  if (!is_shown) return kNothingReflected;
  view = viewOfPx(view, aim, tile_px, rules.rays, rules.through_lens);
  const Pinhole pinhole = Pinhole(extras.focal_px, extras.principal_px);
  const Spot spot = spotAt(scene, vec3(record.x_px, record.y_px, record.inv_z));
  const Mirror mirror = mirrorAt(scene, pinhole, settings.surfaces, normalAxes(), spot);
  if (all(lessThanEqual(mirror.light, vec3(0.0)))) return kNothingReflected;
  const vec3 eye = metricPoint(pinhole, view.eye);
  Path path;
  path.direction = normalize(metresOf(pinhole, spot.point) - eye);
  path.eye = eye;
  path.share = vec3(1.0);
  path.is_bent = false;
  // Angle of a pixel of the view, if its surface stands on the axis.
  const float px_angle = length(metricPoint(pinhole, view.direction_dx));
  const Gathered gathered =
      gather(scene, pinhole, spot, mirror, path, px_angle, tile_px, counts);
  return packedLight(gathered.light_sum, gathered.share_sum, gathered.count,
                     packedReflectance(gathered.reflectance, mirror.roughness),
                     gathered.closeness, packedPlace(mirror.normal, spot.point.z));
}

// The px of this invocation.
void reflectPx(TracePush push, ReflectRules rules) {
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint x = gl_GlobalInvocationID.x;
  const TilePx at = tilePxAt(x, row, push.tile_size_px, push.tile_grid, push.padding_top_px);
  const uint index = (push.band_row + gl_WorkGroupID.y) * push.atlas_width_px + x;
  uvec3 counts = uvec3(0u);
  ReflectedLight light = kNothingReflected;
  if (at.exists) {
    const ViewParams view = views[at.tile];
    if (view.is_used != 0u) {
      Scene scene = pushedScene(push, false);
      addColor(scene, push.color, rules.color_format, rules.color_is_scaled);
      light = reflectedLight(scene, rules, index, at.px, view, counts);
    }
  }
  if (x < push.atlas_width_px) reflected_band[index] = light;
  addReflectionCounts(counts, UintRef(extras.counters),
                      gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y);
}

#endif  // VIEWLOOM_LIB_MIRRORS_MIRRORED_PX_GLSL_
