// SPDX-License-Identifier: Apache-2.0
// Makes px of what several sources answered to the rays of a band: an invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdWanted) const uint kWanted = 0u;  // kWant... flags
layout(constant_id = kIdRays) const uint kRays = kRaysOfPinholes;
layout(push_constant, scalar) uniform Push {
  MergePush push;
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef {
  RayRecord at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref {
  uint8_t at[];
};

#include "lib/rays/extras.glsl"
#include "lib/rays/views.glsl"
#include "lib/walk/class_counts.glsl"
#include "lib/sources/merge.glsl"
#include "lib/rays/ray_source.glsl"
#include "lib/light/srgb.glsl"
#include "lib/rays/tile_px.glsl"

void store(uint index, Asked asked, Merged merged, uint shows) {
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
    const RayAnswer main_answer = loadAnswer(asked, merged.main_source);
    RecordsRef(extras.records).at[index] =
        RayRecord(main_answer.x_px, main_answer.y_px, main_answer.inv_z, merged.ray_class,
                  main_answer.layer | merged.main_source << kRecordSourceShift, merged.visits);
  }
}

void main() {
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint x_px = gl_GlobalInvocationID.x;
  const TilePx at = tilePxAt(x_px, row, push.tile_size_px, push.tile_grid, push.padding_top_px);
  uvec3 counts = uvec3(0u);
  const Aim aim = aimOf(vec2(at.px) + 0.5, kRays);
  if (at.exists && aim.is_used && views[at.tile].is_used != 0u) {
    const Asked asked = Asked(push.source_count, push.answers_stride, push.first_walks,
                              gl_WorkGroupID.y * push.atlas_width_px + x_px);
    const Merged merged = mergeAnswers(asked);
    const uint band_row = push.band_row + gl_WorkGroupID.y;
    store(band_row * push.atlas_width_px + x_px, asked, merged, views[at.tile].shows);
    count(counts, merged.ray_class);
  }
  addCounts(counts, UintRef(extras.counters), gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y);
}
