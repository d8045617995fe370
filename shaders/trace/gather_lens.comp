// SPDX-License-Identifier: Apache-2.0
// The second stage of a lens: more rays of each px, compared with the surfaces that the walked rays
// of its block met (shaders/README.md, A lens). The nearest one that holds a ray is what it sees;
// rays that none holds are left out, or walked. Px are the mean of all rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kOwnConstants + 0u) const uint kWanted = 0u;  // kWantLinear or nothing
layout(constant_id = kOwnConstants + 1u) const uint kColorFormat = kColorRgba8;
layout(constant_id = kOwnConstants + 2u) const bool kColorIsScaled = false;
layout(constant_id = kOwnConstants + 3u) const bool kIsExact = false;
const bool kIsLayered = false;
const bool kSeesThrough = false;
const bool kMeetsBacks = false;
const bool kRaysArePlain = false;
layout(push_constant, scalar) uniform Push {
  GatherPush push;
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
layout(set = 0, binding = kBindingMetLists, scalar) readonly buffer MetLists {
  uint lists[];
};
layout(set = 0, binding = kBindingSums, scalar) readonly buffer Sums {
  vec3 sums[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Vec2Ref {
  vec2 at[];
};

#include "lib/lens.glsl"
#include "lib/met_blocks.glsl"
#include "lib/met_surface.glsl"
#include "lib/ray_light.glsl"
#include "lib/ray_start.glsl"

// Rays that are compared with a surface at a time.
const uint kAtOnce = 4u;

// The plane of a surface as a linear function g of homogeneous image coordinates: g(P) = 1 on it,
// less in front of it. Of the parts of rays.
struct PlaneParts {
  float eye;
  float direction;
  float dx;
  float dy;
};

PlaneParts partsOf(vec3 plane, ViewParams view, vec3 direction) {
  return PlaneParts(dot(plane, view.eye), dot(plane, direction), dot(plane, view.direction_dx),
                    dot(plane, view.direction_dy));
}

// A ray of the px: through a point of the lens (as px of the tile for each 1/m) and beside the
// middle of the px.
struct LensRay {
  vec2 lens_px_m;
  vec2 beside_px;
};

// Steps of a px of the tile that a ray makes by the lens are up, and rows run down.
vec3 eyeOf(ViewParams view, LensRay ray) {
  return view.eye + ray.lens_px_m.x * view.direction_dx - ray.lens_px_m.y * view.direction_dy;
}

vec3 directionOf(ViewParams view, vec3 direction, LensRay ray) {
  const vec2 step_px =
      ray.beside_px - view.lens_inv_focus * vec2(ray.lens_px_m.x, -ray.lens_px_m.y);
  return direction + step_px.x * view.direction_dx + step_px.y * view.direction_dy;
}

// Depth along the view's axis at which the ray meets the plane from the front, m; < 0: nowhere.
float depthAt(PlaneParts parts, ViewParams view, LensRay ray) {
  const vec2 step_px =
      ray.beside_px - view.lens_inv_focus * vec2(ray.lens_px_m.x, -ray.lens_px_m.y);
  const float in_front =
      1.0 - parts.eye - (ray.lens_px_m.x * parts.dx - ray.lens_px_m.y * parts.dy);
  const float towards = parts.direction + step_px.x * parts.dx + step_px.y * parts.dy;
  return in_front > 0.0 && towards > 0.0 ? in_front / towards : -1.0;
}

// Over the px, as the walked ones are: the first axes of Roberts' R4 sequence.
vec2 besideOf(uint point) {
  return fract(0.5 + float(point) * vec2(0.8566748838545029, 0.7338918566271260)) - 0.5;
}

LensRay lensRay(ViewParams view, uint pattern_index, uint point) {
  const vec2 at = Vec2Ref(extras.lens_points).at[point * kLensPatternArea_px + pattern_index];
  return LensRay(view.lens_px_m * at, besideOf(point));
}

// What a ray has met so far.
struct Nearest {
  float depth;
  uint name;
};

uvec2 loadSurface(Extent extent, MetSurface surface) {
  const uvec2 block = uvec2(surface.first_px) >> surface.level;
  return loadCell(push.layers, surface.layer, extent, surface.level, block);
}

// The plane, of homogeneous image coordinates.
vec3 planeOf(MetSurface surface, uvec2 bits) {
  const vec2 slope = unpackSlopes(bits.y);
  const float inv_z = surface.level == kLevelFacets
                          ? uintBitsToFloat(bits.x & ~kForwardLinkFlag)
                          : planeCenter(bits);
  const vec2 center = vec2(surface.first_px) + 0.5 * float(1u << surface.level);
  return vec3(slope, inv_z - dot(slope, center));
}

void compare(uint name, Extent extent, ViewParams view, vec3 direction,
             LensRay rays[kAtOnce], inout Nearest nearest[kAtOnce]) {
  const MetSurface surface = metSurface(name);
  const PlaneParts parts = partsOf(planeOf(surface, loadSurface(extent, surface)), view, direction);
  const vec2 low = vec2(surface.first_px);
  const vec2 high = low + float(1u << surface.level);
  for (uint i = 0u; i < kAtOnce; ++i) {
    const float depth = depthAt(parts, view, rays[i]);
    const vec3 point = eyeOf(view, rays[i]) + depth * directionOf(view, direction, rays[i]);
    const vec2 at = point.xy / point.z;
    const bool holds = depth > 0.0 && point.z > 0.0 && all(greaterThanEqual(at, low)) &&
                       all(lessThanEqual(at, high)) && depth < nearest[i].depth;
    nearest[i].depth = holds ? depth : nearest[i].depth;
    nearest[i].name = holds ? name : nearest[i].name;
  }
}

vec3 lightOfTexel(uint layer, vec2 at, ivec2 cell, Extent extent) {
  uint index = uint(cell.y * extent.size_px.x + cell.x);
  uint count = uint(extent.size_px.x * extent.size_px.y);
  if (kColorIsScaled) {
    const ColorSizes sizes = ColorSizes(extras.color_size_px, extras.color_stride);
    const ivec2 size_px = colorSize(sizes, layer);
    const ivec2 texel =
        clamp(ivec2(at / vec2(extent.size_px) * vec2(size_px)), ivec2(0), size_px - 1);
    index = uint(texel.y * size_px.x + texel.x);
    count = extras.color_stride;
  }
  const vec3 texel = loadTexel(push.color, layer, count, kColorFormat, index).rgb;
  return linearFromSrgb(codesOfBlend(texel) / 255.0);
}

// The blur averages over texels, so the nearest one will do.
vec3 lightOf(Nearest met, Extent extent, ViewParams view, vec3 direction, LensRay ray) {
  const MetSurface surface = metSurface(met.name);
  const vec3 point = eyeOf(view, ray) + met.depth * directionOf(view, direction, ray);
  const vec2 at = point.xy / point.z;
  const ivec2 last = min(surface.first_px + int(1u << surface.level), extent.size_px) - 1;
  const ivec2 cell = clamp(ivec2(floor(at)), surface.first_px, last);
  return lightOfTexel(surface.layer, at, cell, extent);
}

// The ray, walked: from as far along as nothing can be before.
vec3 lightOfWalk(Scene scene, ViewParams view, Ray ray, float bound) {
  const WalkStart start = startOf(scene, ray, bound);
  const Walk walk = walkRay(scene, ray, start, view.inv_z_tolerance, view.eye.z);
  const Light seen = opaqueLight(scene, ray, walk);
  const vec3 blend = seen.is_known ? seen.color.rgb : blendOfBackground();
  return linearFromSrgb(codesOfBlend(blend) / 255.0);
}

// What a ray sees, as light; a negative number if it is left out. A surface is what the ray sees if
// nothing of the source stands nearer than that, and apart from it, all the way there.
vec3 lightOfRay(Scene scene, ViewParams view, vec3 direction, LensRay lens_ray, Nearest met) {
  const bool is_met = met.name != kMetNothing;
  if (!kIsExact) {
    return is_met ? lightOf(met, scene.extent, view, direction, lens_ray) : vec3(-1.0);
  }
  view.eye = eyeOf(view, lens_ray);
  const vec3 along = directionOf(view, direction, lens_ray);
  const Ray ray = makeAnyRay(view.eye * scene.inv_z_near, along, vec2(scene.extent.size_px),
                             scene.inv_z_near);
  if (ray.t_begin >= ray.t_end) return vec3(-1.0);
  const vec3 point = view.eye + met.depth * along;
  const vec2 end_px = is_met ? point.xy / point.z : (ray.start + ray.extent).xy;
  const float bound = startBound(scene, min(ray.start.xy, end_px), max(ray.start.xy, end_px));
  const float inv_z = is_met ? 1.0 / point.z : 0.0;
  const float apart = connectionTolerance(scene.kappa.x, scene.kappa.y, inv_z);
  if (is_met && bound <= inv_z + apart) {
    return lightOf(met, scene.extent, view, direction, lens_ray);
  }
  return lightOfWalk(scene, view, ray, bound);
}

Scene sceneOf(GatherPush given) {
  Scene scene;
  scene.layers = given.layers;
  scene.layer_count = given.layer_count;
  scene.extent = makeExtent(ivec2(sizeOf(given.source_size_px)));
  scene.inv_z_near =
      max(uintBitsToFloat(measured_head.inv_z_max_bits), kInvZNearMin) * kInvZNearMargin;
  scene.fills_border = (given.fill & kFillBorder) != 0u;
  scene.kappa = vec2(measured_head.kappa_abs, measured_head.kappa_rel);
  return scene;
}

void main() {
  const uvec2 tile_size = sizeOf(push.tile_size_px);
  const uvec2 tile_grid = sizeOf(push.tile_grid);
  const uint x = gl_GlobalInvocationID.x;
  const uint atlas_row = push.first_row + gl_WorkGroupID.y;
  const uint column = x / tile_size.x;
  if (column >= tile_grid.x || atlas_row < push.padding_top_px) return;
  const uint row = atlas_row - push.padding_top_px;
  const uint tile_row = row / tile_size.y;
  const ViewParams view = views[tile_row * tile_grid.x + column];
  if (view.is_used == 0u) return;
  const uvec2 px = uvec2(x, row) - uvec2(column, tile_row) * tile_size;
  const uvec2 per_tile = blocksPerTile(push);
  const uvec2 block = px / kMetBlockSide_px + uvec2(column, tile_row) * per_tile;
  const uint list = ((block.y - push.first_block_row) * blocksPerRow(push) + block.x) *
                    kMetListStride;

  const uint index = gl_WorkGroupID.y * push.atlas_width_px + x;
  const Scene scene = sceneOf(push);
  const uint surface_count = lists[list];
  const uint pattern_index = lensPatternIndex(px);
  const vec2 middle = vec2(px) + 0.5;
  const vec3 direction =
      view.direction + middle.x * view.direction_dx + middle.y * view.direction_dy;
  vec3 light = sums[index] * float(push.walked_count);
  uint count = push.walked_count;
  const uint end = surface_count == 0u ? 0u : push.gathered_count;
  for (uint first = 0u; first < end; first += kAtOnce) {
    LensRay rays[kAtOnce];
    Nearest nearest[kAtOnce];
    for (uint i = 0u; i < kAtOnce; ++i) {
      const uint point = min(first + i, push.gathered_count - 1u);
      rays[i] = lensRay(view, pattern_index, push.walked_count + point);
      nearest[i] = Nearest(kDepthMax, kMetNothing);
    }
    for (uint i = 0u; i < surface_count; ++i) {
      compare(lists[list + 1u + i], scene.extent, view, direction, rays, nearest);
    }
    for (uint i = 0u; i < kAtOnce; ++i) {
      if (first + i >= push.gathered_count) continue;
      const vec3 seen = lightOfRay(scene, view, direction, rays[i], nearest[i]);
      if (seen.r < 0.0) continue;
      light += seen;
      ++count;
    }
  }
  const vec3 codes = codesFromLinear(light / float(count));
  band[index] = packCodes(codes);
  if ((kWanted & kWantLinear) != 0u) {
    Vec4Ref(extras.linear).at[index] = vec4(clamp(codes / 255.0, 0.0, 1.0), 1.0);
  }
}
