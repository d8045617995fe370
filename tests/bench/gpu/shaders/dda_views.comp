// SPDX-License-Identifier: Apache-2.0
// McGuire & Mara, "Efficient GPU Screen-Space Ray Tracing" (JCGT 2014), over the px of one layer
// after the other: a ray is straight in (x, y, 1/Z), and hits the first px whose sample, kappa
// thick, it meets.
//
// Tried with 8 px an invocation, CPU ns a ray of the synthetic quilt of two layers with a cone of
// 0.7 | 2 | 7 degrees on lavapipe, 2026-11-21: one layer after the other 19.7 | 32.6 | 91.6, both
// in one walk 20.4 | 37.9 | 101.6.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"

#include "rival_light.glsl"

// Layer l + 1 lies behind layer l: it is walked only from where the ray first was behind that one.
Found findHit(Ray ray) {
  const ivec2 size_px = sourceSize();
  const int pitch = int(invZPitch(uint(size_px.x)));
  const bvec2 goes_back = lessThan(ray.extent.xy, vec2(0.0));
  const ivec2 direction = mix(ivec2(1), ivec2(-1), goes_back);
  const ivec2 ahead = mix(ivec2(1), ivec2(0), goes_back);
  const vec2 toward = vec2(direction) * ray.pace;
  const int step_y = goes_back.y ? -pitch : pitch;
  float stop_t = ray.t_end;
  float begin_t = ray.t_begin;
  Found found = Found(false, false, ray.t_end, ray.t_end, 0u);
  uint layer = 0u;
  for (;;) {
    if (isNever(1u)) break;
    const ivec2 cell =
        ivec2(clamp(ray.start.xy + begin_t * ray.extent.xy, vec2(0.0), vec2(size_px - 1)));
    vec2 next_t = (vec2(cell + ahead) - ray.start.xy) * toward;
    int at = layerBegin(layer) + pixelIndex(cell);
    float enter_t = begin_t;
    float enter_inv_z = ray.start.z + begin_t * ray.extent.z;
    float exit_t = enter_t;
    float inv_z = 0.0;
    float passed_t = kNotPassed;
    bool meets = false;
    for (;;) {
      if (isNever(2u)) break;
      inv_z = texelFetch(inv_z_texels, at).x;
      const bool cross_x = next_t.x <= next_t.y;
      exit_t = min(min(next_t.x, next_t.y), stop_t);
      const float exit_inv_z = ray.start.z + exit_t * ray.extent.z;
      const bool is_behind = enter_inv_z < inv_z - kappaOf(inv_z);
      meets = exit_inv_z <= inv_z && !is_behind;
      passed_t = is_behind ? min(passed_t, enter_t) : passed_t;
      const bool is_done = meets || exit_t >= stop_t;
      next_t += mix(vec2(0.0, ray.pace.y), vec2(ray.pace.x, 0.0), bvec2(cross_x));
      at += cross_x ? direction.x : step_y;
      enter_t = is_done ? enter_t : exit_t;
      enter_inv_z = is_done ? enter_inv_z : exit_inv_z;
      if (is_done) break;
    }
    finishLayer(ray, layer, meets, inv_z, enter_t, exit_t, passed_t, found, stop_t);
    begin_t = passed_t;
    ++layer;
    if (passed_t == kNotPassed || layer >= push.layer_count) break;
  }
  return found;
}

float boundOfRun(ViewParams view, Run run) {
  return push.inv_z_near;
}

uint pixelOf(ViewParams view, Run run, uint i, float bound) {
  const Ray ray = rayOf(view, vec2(float(run.first_x + i) + 0.5, run.tile_y));
  Found found = Found(false, false, 1.0, 1.0, 0u);  // never sees the image: its border, from afar
  if (ray.t_begin < ray.t_end) found = findHit(ray);
  if (kWritesInvZ) {
    return floatBitsToUint(found.is_hit ? ray.start.z + found.t * ray.extent.z : kNoSurface);
  }
  return codeOf(ray, found);
}

#include "rival_views.glsl"
