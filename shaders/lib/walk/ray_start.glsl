// SPDX-License-Identifier: Apache-2.0
// Where walks of rays start: as far along as nothing can be before.
#ifndef VIEWLOOM_LIB_WALK_RAY_START_GLSL_
#define VIEWLOOM_LIB_WALK_RAY_START_GLSL_

#include "lib/structure/node.glsl"
#include "lib/rays/ray.glsl"
#include "lib/walk/walk.glsl"

// Cells of this level share a start bound; rays over more of them start at the bound of the whole
// source.
const uint kStartLevel = 5u;
const int kStartCellsMax = 16;
// Distance a start keeps from the bound, as a share of the largest inv_z: 16 ulp, more than the
// rounding of positions along a ray.
const float kStartMargin = 16.0 / 8388608.0;

// The column at an image point, or the one nearest to it: points may lie beyond all integers.
ivec2 columnAt(Scene scene, vec2 point) {
  return ivec2(clamp(point, vec2(0.0), vec2(scene.extent.size_px - 1)));
}

// The largest inv_z in the cells that neighbouring rays pass, from corner to corner of their
// rectangle.
float startBound(Scene scene, vec2 low_px, vec2 high_px) {
  const ivec2 first = columnAt(scene, low_px) >> int(kStartLevel);
  const ivec2 last = columnAt(scene, high_px) >> int(kStartLevel);
  const ivec2 count = last - first + 1;
  if (count.x * count.y > kStartCellsMax) return scene.inv_z_near;
  float bound = 0.0;
  ivec2 cell = first;
  for (;;) {
    if (isNever(scene, 4u)) break;
    const uvec2 bits = loadCell(scene.layers, 0u, scene.extent, kStartLevel, uvec2(cell));
    bound = max(bound, nodeBox(unpackNode(bits)).y);
    cell = cell.x == last.x ? ivec2(first.x, cell.y + 1) : ivec2(cell.x + 1, cell.y);
    if (cell.y > last.y) break;
  }
  return min(bound + kStartMargin * scene.inv_z_near, scene.inv_z_near);
}

// The start of a ray: as far along as nothing can be, then the column it is in; the border next to
// where it goes when it never sees the image. `is_plain`: all rays of the kernel are plain.
WalkStart startOf(Scene scene, Ray ray, float bound, bool is_plain) {
  const bool goes_away = is_plain || (ray.extent.z < 0.0 && ray.start.z > bound);
  const float t_bound = goes_away ? (bound - ray.start.z) / ray.extent.z : 0.0;
  const float t = ray.t_begin < ray.t_end ? min(max(t_bound, ray.t_begin), ray.t_end) : 1.0;
  return WalkStart(t, columnAt(scene, ray.start.xy + t * ray.extent.xy), kStateUnknown);
}

#endif  // VIEWLOOM_LIB_WALK_RAY_START_GLSL_
