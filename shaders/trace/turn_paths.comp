// SPDX-License-Identifier: Apache-2.0
// Sends rays on from the surfaces of one of several sources: those that the px of a piece of a band
// show, or those that their reflected rays met. An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdRays) const uint kRays = kRaysOfPinholes;
layout(constant_id = kIdThroughLens) const bool kThroughLens = false;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

layout(set = 0, binding = kBindingPaths, scalar) buffer Paths {
  ReflectedPath paths[];
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
#include "lib/mirrors/reflected_light.glsl"
#include "lib/rays/tile_px.glsl"

// Whether no reflected ray starts here.
bool isBeside(TilePx at, RayRecord record, out Aim aim, out ViewParams view) {
  aim = aimOf(vec2(at.px) + 0.5, kRays);
  view = views[at.tile];
  const bool is_hit = record.ray_class == kClassHit || record.ray_class == kClassHitAssumed;
  return !at.exists || view.is_used == 0u || !is_hit || !aim.is_used || record.inv_z <= 0.0 ||
         (view.shows & kShowsDepth) != 0u;
}

// The path turned at a spot of this source, whose mirror this is; `came` is in its camera.
void goOn(Scene scene, Pinhole pinhole, Spot spot, Mirror mirror, Path came, uvec2 px,
          inout ReflectedPath path) {
  const vec2 place = samplePlace(push.sample_index, path.sample_count, push.bounce, px,
                                 extras.sample_index);
  turn(mirror, spot, pinhole, place, came);
  const float kappa = stepAt(scene.kappa, spot.point.z);
  path.is_on = 1u;
  path.is_bent = came.is_bent ? 1u : 0u;
  path.walk = settings.walk;
  path.layer = spot.layer;
  path.spot = spot.point;
  path.moved_px = settings.tolerance_px * path.px_angle;
  path.surface_error = surfaceError(scene, pinhole, spot, came.eye, path.moved_px);
  path.apart_m = kappa / (spot.point.z * spot.point.z);
  const vec3 start = vec3(spot.point.xy, spot.point.z + path.surface_error);
  path.start = pointToFirst(metresOf(pinhole, start));
  path.direction = directionToFirst(came.direction);
  path.eye = pointToFirst(came.eye);
  path.own_share = push.bounce == 0u ? came.share : path.own_share;
  path.share = push.bounce == 0u ? vec3(1.0) : came.share;
}

// Rays of this sample of a px that shows this source.
void begin(Scene scene, Pinhole pinhole, TilePx at, RayRecord record, inout ReflectedPath path) {
  Aim aim;
  ViewParams view;
  if (isBeside(at, record, aim, view)) return;
  view = viewOfPx(view, aim, at.px, kRays, kThroughLens);
  const Spot spot = spotAt(scene, vec3(record.x_px, record.y_px, record.inv_z));
  const Mirror mirror = mirrorAt(scene, pinhole, settings.surfaces, normalAxes(), spot);
  if (all(lessThanEqual(mirror.light, vec3(0.0)))) return;
  const vec3 eye = metricPoint(pinhole, view.eye);
  const vec3 to_spot = metresOf(pinhole, spot.point) - eye;
  const Path came = Path(normalize(to_spot), eye, vec3(1.0), false);
  const float cosine = cosineTowards(mirror, came);
  const bool is_rough = isRough(mirror, cosine);
  path.sample_count = is_rough ? settings.sample_count : 1u;
  path.light = vec3(0.0);
  if (push.sample_index == 0u) {
    path.light_sum = vec3(0.0);
    path.share_sum = vec3(0.0);
    path.closeness_sum = 0.0;
    // The same for all sources.
    path.place = packedPlace(directionToFirst(mirror.normal), 1.0 / length(to_spot));
  }
  if (push.sample_index >= path.sample_count) return;
  // Angle of a pixel of the view, if its surface stands on the axis.
  path.px_angle = length(metricPoint(pinhole, view.direction_dx));
  goOn(scene, pinhole, spot, mirror, came, at.px, path);
  if (push.sample_index > 0u) return;
  path.reflectance = packedReflectance(is_rough ? albedoOf(mirror, cosine) : path.own_share,
                                       mirror.roughness);
}

// From where a ray met this source.
void bounce(Scene scene, Pinhole pinhole, uvec2 px, inout ReflectedPath path) {
  const Spot spot = spotAt(scene, path.spot);
  const Mirror mirror = mirrorAt(scene, pinhole, settings.surfaces, normalAxes(), spot);
  path.is_on = 0u;
  if (all(lessThanEqual(mirror.light, vec3(0.0)))) return;
  const Path came = Path(directionFromFirst(path.direction), pointFromFirst(path.eye), path.share,
                         false);
  goOn(scene, pinhole, spot, mirror, came, px, path);
}

void main() {
  const uint x = gl_GlobalInvocationID.x;
  if (x >= push.atlas_width_px) return;
  const uint row = push.first_row + gl_WorkGroupID.y;
  const TilePx at = tilePxAt(x, row, push.tile_size_px, push.tile_grid, push.padding_top_px);
  const uint index = gl_WorkGroupID.y * push.atlas_width_px + x;
  const Scene scene = pushedScene(push, false);
  const Pinhole pinhole = Pinhole(extras.focal_px, extras.principal_px);
  if (push.bounce > 0u) {
    if (paths[index].is_on == 0u || paths[index].walk != settings.walk) return;
    ReflectedPath path = paths[index];
    bounce(scene, pinhole, at.px, path);
    paths[index] = path;
    return;
  }
  const uint band_row = push.band_row + gl_WorkGroupID.y;
  const RayRecord record = RecordsRef(extras.records).at[band_row * push.atlas_width_px + x];
  const bool is_own = record.layer >> kRecordSourceShift == settings.recorded_as;
  // The first of all is for those that no source sends on, too.
  const bool is_first = push.sample_index == 0u && (push.fill & kFillFirst) != 0u;
  if (!is_own && !is_first) return;
  ReflectedPath path = paths[index];
  path.is_on = 0u;
  path.sample_count = 0u;
  if (is_own) begin(scene, pinhole, at, record, path);
  paths[index] = path;
}
