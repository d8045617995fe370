// SPDX-License-Identifier: Apache-2.0
// The second stage of a lens: more rays of each px, compared with the sheets that the walked rays
// of its block met (shaders/lens.md). In settled blocks the one sheet is what they see,
// elsewhere the nearest that has a facet where the ray meets it. In mode exact rays that something
// may stand in the way of are walked. Px are the mean of all rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdWanted) const uint kWanted = 0u;  // kWantLinear or nothing
layout(constant_id = kIdColorFormat) const uint kColorFormat = kColorRgba8;
layout(constant_id = kIdColorIsScaled) const bool kColorIsScaled = false;
layout(constant_id = kIdIsExact) const bool kIsExact = false;
layout(push_constant, scalar) uniform Push {
  GatherPush push;
};
#include "lib/rays/views.glsl"
#include "lib/rays/extras.glsl"

layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};
layout(set = 0, binding = kBindingMetLists, scalar) readonly buffer MetLists {
  MetList lists[];
};
layout(set = 0, binding = kBindingSums, scalar) readonly buffer Sums {
  vec3 sums[];
};

#include "lib/lens/lens.glsl"
#include "lib/lens/lens_rays.glsl"
#include "lib/rays/met_blocks.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/walk/ray_start.glsl"

// Rays that are compared with a sheet at a time.
const uint kAtOnce = 4u;

LensRay lensRay(ViewParams view, vec3 direction, uint pattern_index, uint point) {
  const vec2 at = lens_points[point * kLensPatternArea_px + pattern_index];
  return makeLensRay(view, direction, view.lens_px_m * at, besideOf(point));
}

// Nearest hit of a ray so far; no layer: nothing.
struct Nearest {
  float inv_z;
  uint layer;
  ivec2 cell;
};

// Whether the layer has a surface there that the one before it has not.
bool isOwnSurface(uint layer, Extent extent, ivec2 cell, vec2 at, float inv_z) {
  if (layer == 0u) return true;
  const uvec2 front = loadFacet(push.layers, layer - 1u, extent, cell);
  const float apart =
      stepAt(connectedSteps(measured_head), inv_z);
  return facetAtPoint(front, cell, at) - inv_z > apart;
}

// Facets of the surface that a sheet stands for lie within its reach, and those beside them within
// twice that. Which of two sheets is nearer only their facets tell: both may stand for surfaces
// that lie closer than their reach. A ray that is behind a surface to its end has not met the sky:
// where walked ones are, the sky holds none.
void compare(MetSheet sheet, uint kinds, Extent extent, LensRay rays[kAtOnce],
             inout Nearest nearest[kAtOnce]) {
  const float least_inv_z = (kinds & kMetSeesAssumed) != 0u ? 0.0 : -1.0;
  for (uint i = 0u; i < kAtOnce; ++i) {
    const vec3 point = meets(sheet.plane, rays[i]);
    const vec2 at = point.xy / point.z;
    const ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), extent.size_px - 1);
    const uvec2 facet = loadFacet(push.layers, sheet.layer, extent, cell);
    const float inv_z = facetAtPoint(facet, cell, at);
    const bool is_inside = all(greaterThanEqual(at, vec2(0.0))) &&
                           all(lessThan(at, vec2(extent.size_px)));
    const float beyond_inv_z = max(nearest[i].inv_z, least_inv_z);
    const bool holds = point.z > 0.0 && is_inside && inv_z > beyond_inv_z &&
                       abs(inv_z - dot(sheet.plane, vec3(at, 1.0))) <= 2.0 * sheet.reach &&
                       isOwnSurface(sheet.layer, extent, cell, at, inv_z);
    nearest[i].inv_z = holds ? inv_z : nearest[i].inv_z;
    nearest[i].layer = holds ? sheet.layer : nearest[i].layer;
    nearest[i].cell = holds ? cell : nearest[i].cell;
  }
}

// Light of the nearest texel: the blur averages over texels, so that will do.
vec3 lightOf(Nearest met, Extent extent) {
  uint index = uint(met.cell.y * extent.size_px.x + met.cell.x);
  uint count = uint(extent.size_px.x * extent.size_px.y);
  if (kColorIsScaled) {
    const ColorSizes sizes = ColorSizes(extras.color_size_px, extras.color_stride);
    const ivec2 size_px = colorSize(sizes, met.layer);
    const vec2 middle = (vec2(met.cell) + 0.5) / vec2(extent.size_px);
    const ivec2 texel = clamp(ivec2(middle * vec2(size_px)), ivec2(0), size_px - 1);
    index = uint(texel.y * size_px.x + texel.x);
    count = extras.color_stride;
  }
  const vec3 texel = loadTexel(push.color, met.layer, count, kColorFormat, index).rgb;
  return linearFromSrgb(codesOfBlend(texel, kColorFormat) / 255.0);
}

// The light of rays, and how many they are.
struct LightSum {
  vec3 light;
  uint count;
};

// The ray, walked: from as far along as nothing can be before.
vec3 lightOfWalk(Scene scene, ViewParams view, Ray ray, float bound) {
  const WalkStart start = startOf(scene, ray, bound, false);
  Walk walk =
      walkRay(scene, kSeesFirstSurfaces, ray, start, view.inv_z_tolerance, view.eye.z);
  const Light seen = opaqueLight(scene, ray, walk);
  const vec3 blend =
      seen.is_known ? seen.color.rgb : blendOfBackground(push.fill, kColorFormat);
  return linearFromSrgb(codesOfBlend(blend, kColorFormat) / 255.0);
}

// In mode exact: what a ray sees that has met this, as light. It is this if nothing of the source
// stands nearer, and apart from it, all the way there. Negative if it never comes to the source.
vec3 exactLight(Scene scene, ViewParams view, LensRay lens_ray, Nearest met) {
  const bool is_met = met.layer < kLayerCountMax;
  view.eye = lens_ray.eye;
  const Ray ray = makeAnyRay(view.eye * scene.inv_z_near, lens_ray.direction,
                             vec2(scene.extent.size_px), scene.inv_z_near);
  if (ray.t_begin >= ray.t_end) return vec3(-1.0);
  const vec2 end_px = is_met ? vec2(met.cell) + 0.5 : (ray.start + ray.extent).xy;
  const float bound = startBound(scene, min(ray.start.xy, end_px), max(ray.start.xy, end_px));
  const float apart = stepAt(scene.kappa, met.inv_z);
  if (is_met && bound <= met.inv_z + apart) return lightOf(met, scene.extent);
  return lightOfWalk(scene, view, ray, bound);
}

// Light of a ray with this hit; negative if it is left out.
vec3 lightOfRay(Scene scene, ViewParams view, LensRay ray, Nearest met, vec3 light_of_none) {
  if (kIsExact) return exactLight(scene, view, ray, met);
  return met.layer < kLayerCountMax ? lightOf(met, scene.extent) : light_of_none;
}

// Light of rays that meet no sheet: the background, if the walked ones without a surface see it.
// Otherwise it is unknown, and the mean of the pixel's walked rays stands in.
vec3 lightOfNone(uint kinds, LightSum walked) {
  const uint both = kMetSeesBackground | kMetSeesAssumed;
  if ((kinds & both) != kMetSeesBackground) return walked.light / float(walked.count);
  const vec3 background = blendOfBackground(push.fill, kColorFormat);
  return linearFromSrgb(codesOfBlend(background, kColorFormat) / 255.0);
}

Scene sceneOf(GatherPush given) {
  Scene scene;
  scene.layers = given.layers;
  scene.layer_count = given.layer_count;
  scene.extent = makeExtent(ivec2(sizeOf(given.source_size_px)));
  scene.fills_border = (given.fill & kFillBorder) != 0u;
  addMeasured(scene, measured_head);
  addColor(scene, given.color, kColorFormat, kColorIsScaled);
  return scene;
}

// Points of a lens: [first, end).
struct PointRange {
  uint first;
  uint end;
};

// For a pixel of a settled block: nothing stands before the sheet, which is everywhere.
LightSum sumOnSheet(Scene scene, ViewParams view, vec3 direction, uint pattern_index,
                    MetSheet sheet, PointRange points, LightSum sum) {
  for (uint point = points.first; point < points.end; ++point) {
    const vec3 at = meets(sheet.plane, lensRay(view, direction, pattern_index, point));
    const ivec2 cell = ivec2(floor(at.xy / at.z));
    const ivec2 inside = clamp(cell, ivec2(0), scene.extent.size_px - 1);
    const bool is_met = at.z > 0.0 && cell == inside;
    const vec3 light = lightOf(Nearest(0.0, sheet.layer, inside), scene.extent);
    sum.light += is_met ? light : vec3(0.0);
    sum.count += is_met ? 1u : 0u;
  }
  return sum;
}

LightSum sumOnSheets(Scene scene, ViewParams view, vec3 direction, uint pattern_index, uint list,
                     uint sheet_count, PointRange points, LightSum sum) {
  const uint kinds = lists[list].kinds;
  const vec3 light_of_none = lightOfNone(kinds, sum);
  for (uint point = points.first; point < points.end; point += kAtOnce) {
    LensRay rays[kAtOnce];
    Nearest nearest[kAtOnce];
    for (uint i = 0u; i < kAtOnce; ++i) {
      rays[i] = lensRay(view, direction, pattern_index, min(point + i, points.end - 1u));
      nearest[i] = Nearest(-1.0, kLayerCountMax, ivec2(0));
    }
    for (uint i = 0u; i < sheet_count; ++i) {
      compare(lists[list].sheets[i], kinds, scene.extent, rays, nearest);
    }
    for (uint i = 0u; i < kAtOnce; ++i) {
      if (point + i >= points.end) continue;
      const vec3 seen = lightOfRay(scene, view, rays[i], nearest[i], light_of_none);
      if (seen.r < 0.0) continue;
      sum.light += seen;
      ++sum.count;
    }
  }
  return sum;
}

// The mean of a px's walked rays and of those that are gathered.
vec3 lightOfPx(Scene scene, ViewParams view, uvec2 px, uint list, vec3 walked_light) {
  const uint kinds = lists[list].kinds;
  const bool is_settled = (kinds & kMetSettled) != 0u;
  const bool is_complete = (kinds & kMetComplete) != 0u;
  const uint sheet_count = lists[list].count;
  const uint pattern_index = lensPatternIndex(px);
  const vec2 middle = vec2(px) + 0.5;
  const vec3 direction =
      view.direction + middle.x * view.direction_dx + middle.y * view.direction_dy;
  LightSum sum = LightSum(walked_light, lists[list].walked_count);
  // Rays that are not walked are gathered.
  const uint first = is_complete ? lists[list].walked_count : push.walked_count;
  // Exact rays of settled blocks are looked at as all others are.
  const bool gathers = sheet_count > 0u && sheet_count != kMetTooMany;
  const bool is_filled = is_settled && !kIsExact;
  const PointRange points = PointRange(first, push.point_count);
  const PointRange none = PointRange(first, first);
  sum = sumOnSheet(scene, view, direction, pattern_index, lists[list].sheets[0],
                   gathers && is_filled ? points : none, sum);
  sum = sumOnSheets(scene, view, direction, pattern_index, list, sheet_count,
                    gathers && !is_filled ? points : none, sum);
  return sum.light / float(sum.count);
}

void main() {
  const uvec2 tile_size = sizeOf(push.tile_size_px);
  const uvec2 tile_grid = sizeOf(push.tile_grid);
  const uint x = gl_GlobalInvocationID.x;
  const uint band_row = push.piece_row + gl_WorkGroupID.y;
  const uint atlas_row = push.first_row + band_row;
  const uint column = x / tile_size.x;
  if (column >= tile_grid.x || atlas_row < push.padding_top_px) return;
  const uint row = atlas_row - push.padding_top_px;
  const uint tile_row = row / tile_size.y;
  const ViewParams view = views[tile_row * tile_grid.x + column];
  if (view.is_used == 0u) return;
  const uvec2 px = uvec2(x, row) - uvec2(column, tile_row) * tile_size;
  const BlockGrid grid = gridOf(push);
  const uvec2 block = px / kMetBlockSide_px + uvec2(column, tile_row) * blocksPerTile(grid);
  const uint list = (block.y - push.first_block_row) * blocksPerRow(grid) + block.x;
  const uint index = band_row * push.atlas_width_px + x;
  const vec3 light = lightOfPx(sceneOf(push), view, px, list, sums[index]);
  const vec3 codes = codesFromLinear(light);
  band[index] = packCodes(codes);
  if ((kWanted & kWantLinear) != 0u) {
    Vec4Ref(extras.linear).at[index] = vec4(clamp(codes / 255.0, 0.0, 1.0), 1.0);
  }
}
