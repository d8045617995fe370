// SPDX-License-Identifier: Apache-2.0
// Makes px of what several sources answered to the rays of a band: an invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kOwnConstants + 0u) const uint kWanted = 0u;  // kWant... flags
layout(constant_id = kOwnConstants + 1u) const uint kRays = kRaysOfPinholes;
layout(push_constant, scalar) uniform Push {
  MergePush push;
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
layout(set = 0, binding = kBindingAnswers, scalar) readonly buffer Answers {
  RayAnswer answers[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef {
  RayRecord at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref {
  uint8_t at[];
};

uint answer_index;  // of the first source, for this invocation's px

RayAnswer loadAnswer(uint source) {
  const uint walks = source < 4u ? push.first_walks.x : push.first_walks.y;
  const uint walk = walks >> (8u * (source & 3u)) & 255u;
  return answers[walk * push.answers_stride + answer_index];
}

#include "lib/class_counts.glsl"
#include "lib/merge.glsl"
#include "lib/ray_source.glsl"
#include "lib/srgb.glsl"

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

void store(uint index, Merged merged, uint shows) {
  const bool shows_depth = (shows & kShowsDepth) != 0u;
  const bool is_known = shows_depth || merged.light.a > 0.5;
  const vec3 grey = vec3(float(depthCode(merged.view_inv_z, extras.depth_scale)));
  const vec3 codes = shows_depth ? grey : merged.light.rgb;
  band[index] = is_known ? packCodes(codes) : push.fill | kOpaqueCode;
  if ((kWanted & kWantDepth) != 0u) FloatRef(extras.depth).at[index] = merged.view_inv_z;
  if ((kWanted & kWantMask) != 0u) Uint8Ref(extras.mask).at[index] = uint8_t(merged.ray_class);
  if ((kWanted & kWantLinear) != 0u) {
    const vec3 srgb = is_known ? codes / 255.0 : unpackUnorm4x8(push.fill).rgb;
    Vec4Ref(extras.linear).at[index] = vec4(clamp(srgb, 0.0, 1.0), 1.0);
  }
  if ((kWanted & kWantRecords) != 0u) {
    const RayAnswer main_answer = loadAnswer(merged.main_source);
    RecordsRef(extras.records).at[index] =
        RayRecord(main_answer.x_px, main_answer.y_px, main_answer.inv_z, merged.ray_class,
                  main_answer.layer | merged.main_source << kRecordSourceShift, merged.visits);
  }
}

void main() {
  const uvec2 tile_size = unpackSize(push.tile_size_px);
  const uvec2 tile_grid = unpackSize(push.tile_grid);
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint x_px = gl_GlobalInvocationID.x;
  const uint column = x_px / tile_size.x;
  const uint tile_row =
      row < push.padding_top_px ? tile_grid.y : (row - push.padding_top_px) / tile_size.y;
  const bool exists = column < tile_grid.x && tile_row < tile_grid.y;
  const uint tile = exists ? tile_row * tile_grid.x + column : 0u;
  uvec3 counts = uvec3(0u);
  const uvec2 first_px = uvec2(column * tile_size.x, push.padding_top_px + tile_row * tile_size.y);
  const Aim aim = aimOf(vec2(uvec2(x_px, row) - first_px) + 0.5);
  if (exists && aim.is_used && views[tile].is_used != 0u) {
    answer_index = gl_WorkGroupID.y * push.atlas_width_px + x_px;
    const Merged merged = mergeAnswers(push.source_count);
    const uint band_row = push.band_row + gl_WorkGroupID.y;
    store(band_row * push.atlas_width_px + x_px, merged, views[tile].shows);
    count(counts, merged.ray_class);
  }
  addCounts(counts, UintRef(extras.counters), gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y);
}
