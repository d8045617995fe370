// SPDX-License-Identifier: Apache-2.0
// The colour of hits that are known: what any walk pays beside itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"

#include "lib/light/color.glsl"
#include "rival_run.glsl"

layout(set = 0, binding = kBindingHits) uniform usamplerBuffer hits;

float boundOfRun(ViewParams view, Run run) {
  return 0.0;
}

uint pixelOf(ViewParams view, Run run, uint i, float bound) {
  const uint at = push.first_row * push.atlas_width_px + run.first_index + i;
  const uvec2 hit = texelFetch(hits, int(at)).xy;
  const bool is_hit = (hit.y & kHitExists) != 0u;
  const ivec2 cell = is_hit ? ivec2(hit.x & 0xffffu, hit.x >> 16) : ivec2(0);
  const vec2 steps =
      vec2((hit.y >> kHitOffsetXShift) & 0x1ffu, (hit.y >> kHitOffsetYShift) & 0x1ffu);
  const vec2 point = vec2(cell) + steps / kSubtexelSteps;
  const uint layer = hit.y & 3u;
  const Extent extent = makeExtent(ivec2(unpackSize(push.source_size_px)));
  const Address unused[kLayerCountMax] = Address[](uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u));
  const uint links = loadLinks(unused, layer, extent, cell);
  const vec4 color =
      surfaceColorPerFacet(unused, unused, extent, kColorRgba8, layer, cell, links, point,
                           vec2(0.0));
  return is_hit ? packCodes(color.rgb) : hit.x;
}

#include "rival_views.glsl"
