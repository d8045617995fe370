// SPDX-License-Identifier: Apache-2.0
// Merges the answers of several sources to reflected rays. After the last ray of a pixel, stores
// the light that comes to it by way of the surface that it shows. An invocation a px of a piece of
// a band.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "lib/light/srgb.glsl"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  MergePathsPush push;
};
layout(set = 0, binding = kBindingPaths, scalar) buffer Paths {
  ReflectedPath paths[];
};
layout(set = 0, binding = kBindingReflected, scalar) writeonly buffer ReflectedBand {
  ReflectedLight reflected_band[];
};

#include "lib/sources/merge.glsl"
#include "lib/mirrors/reflected_light.glsl"
#include "lib/mirrors/reflection_counts.glsl"

bool isOf(uint sources, uint source) {
  return (sources >> source & 1u) != 0u;
}

// Hidden behind what goes on, as far as the answer says.
bool endsBehind(RayAnswer answer) {
  return answer.ray_class == kClassHidden && unpackHalf2x16(answer.light.y).y > 0.5;
}

// Weight of an answer that has a surface.
float certaintyOf(RayAnswer answer, float mirror_inv_z) {
  if (answer.ray_class == kClassHit) return 1.0;
  // Sky, seen behind something, is infinitely far from that.
  if (answer.view_inv_z <= 0.0) return 0.0;
  const float unseen_m = 1.0 / answer.view_inv_z - 1.0 / max(answer.passed_inv_z, 1e-30);
  return certaintyOf(max(unseen_m, 0.0), mirror_inv_z);
}

// Weight of a surface that sources agree on: that of the one that saw most of the way to it.
float certaintyOfHit(Asked asked, RayAnswer hit, float mirror_inv_z) {
  float most_certain = 0.0;
  uint source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    const bool counts = isHit(answer) && areOne(answer, hit);
    most_certain = max(most_certain, counts ? certaintyOf(answer, mirror_inv_z) : 0.0);
    ++source;
    if (source >= asked.source_count) break;
  }
  return most_certain;
}

vec3 linearLight(vec4 codes) {
  return linearFromSrgb(codes.rgb / 255.0);
}

// Light where a ray's own answer is not certain: from the most certain of the other cube maps, else
// none.
vec3 lightAround(Asked asked, uint main_source, float mirror_inv_z) {
  vec3 light = push.environment;
  float most_certain = 0.0;
  uint source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    const bool counts = isOf(push.cube_maps, source) && source != main_source &&
                        (isHit(answer) || endsBehind(answer));
    const float certainty = certaintyOf(answer, mirror_inv_z);
    const bool is_taken = counts && certainty > most_certain;
    light = is_taken ? mix(push.environment, linearLight(lightOf(answer)), certainty) : light;
    most_certain = is_taken ? certainty : most_certain;
    ++source;
    if (source >= asked.source_count) break;
  }
  return light;
}

// One ray: its light, and where it goes on.
void follow(Asked asked, inout ReflectedPath path, inout uvec3 counts) {
  const Merged merged = mergeAnswers(asked);
  const RayAnswer main_answer = loadAnswer(asked, merged.main_source);
  const bool is_hit = merged.ray_class == kClassHit || merged.ray_class == kClassHitAssumed;
  const bool is_back = is_hit && (main_answer.layer & kAnswerIsBack) != 0u;
  const bool ends_behind = !is_hit && endsBehind(main_answer);
  const bool is_seen = is_hit || ends_behind;
  const uint ending = !is_seen                                 ? kReflectionEnvironment
                      : isOf(push.cube_maps, merged.main_source) ? kReflectionCube
                      : is_back                                ? kReflectionBack
                      : merged.ray_class == kClassHit          ? kReflectionHit
                                                               : kReflectionAssumed;
  const float certainty = is_hit        ? certaintyOfHit(asked, main_answer, path.spot.z)
                          : ends_behind ? certaintyOf(main_answer, path.spot.z)
                                        : 0.0;
  const bool has_more = is_seen && merged.ray_class != kClassHit;
  const vec3 around =
      has_more ? lightAround(asked, merged.main_source, path.spot.z) : push.environment;
  const vec3 found = mix(around, linearLight(merged.light), certainty);
  path.light += path.share * found;
  countReflection(counts, ending, path.is_bent != 0u);

  const bool is_last = push.bounce + 1u >= push.bounce_count;
  const float place = is_hit ? merged.view_inv_z : ends_behind ? main_answer.view_inv_z : 0.0;
  path.closeness_sum +=
      push.bounce == 0u ? closenessOf(1.0 / max(place, 1e-30)) / float(path.sample_count) : 0.0;
  path.is_on = is_hit && !is_back && !is_last && isOf(push.mirrors, merged.main_source) ? 1u : 0u;
  path.share *= certainty;
  path.spot = vec3(main_answer.x_px, main_answer.y_px, main_answer.inv_z);
  path.walk = walkOfSource(asked, merged.main_source) + (main_answer.layer >> kAnswerFaceShift);
}

void main() {
  const uint x = gl_GlobalInvocationID.x;
  const uint index = gl_WorkGroupID.y * push.atlas_width_px + x;
  uvec3 counts = uvec3(0u);
  const bool is_last =
      push.bounce + 1u == push.bounce_count && push.sample_index + 1u == push.sample_count;
  const uint band_index = (push.band_row + gl_WorkGroupID.y) * push.atlas_width_px + x;
  const bool exists = x < push.atlas_width_px;
  const bool mirrors = exists && paths[index].sample_count > 0u;
  if (exists && !mirrors && is_last) reflected_band[band_index] = kNothingReflected;
  if (mirrors) {
    const Asked asked =
        Asked(push.source_count, push.answers_stride, push.first_walks, index);
    ReflectedPath path = paths[index];
    if (path.is_on != 0u) follow(asked, path, counts);
    if (push.bounce + 1u == push.bounce_count && push.sample_index < path.sample_count) {
      path.light_sum += path.own_share * path.light;
      path.share_sum += path.own_share;
    }
    paths[index] = path;
    if (is_last) {
      reflected_band[band_index] =
          packedLight(path.light_sum, path.share_sum, path.sample_count, path.reflectance,
                      path.closeness_sum, path.place);
    }
  }
  addReflectionCounts(counts, UintRef(push.counters),
                      gl_WorkGroupID.y * kCounterSets / gl_NumWorkGroups.y);
}
