// SPDX-License-Identifier: Apache-2.0
// The same as trace/reflect.comp, and writes down the hit of the last ray of each px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "followed_abi.h"
#include "lib/memory.glsl"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};
layout(set = 0, binding = kBindingFollowed, scalar) writeonly buffer FollowedBand {
  FollowedRay followed[];
};

#include "lib/mirrors/mirrored_walk.glsl"

Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected) {
  const Ray ray = reflected.ray;
  const Walk walk = walkMirrored(scene, from, reflected);
  const vec3 point = ray.start + walk.t * ray.extent;
  const bool has_passed = walk.passed_t > ray.t_begin && walk.passed_t < walk.t;
  const vec3 passed =
      has_passed ? ray.start + walk.passed_t * ray.extent : vec3(0.0, 0.0, kNoSurface);
  Walk behind = walk;
  const uint body = meetBody(scene, pinhole, ray, behind);
  const vec3 met = ray.start + behind.t * ray.extent;
  const uint row = push.band_row + gl_WorkGroupID.y;
  followed[row * push.atlas_width_px + gl_GlobalInvocationID.x] =
      FollowedRay(1u, from.layer, classOf(walk), walk.is_back ? 1u : 0u, walk.layer, point.x,
                  point.y, point.z, passed.x, passed.y, passed.z, body, met.x, met.y, met.z);
  return foundBy(scene, pinhole, from, ray, walk);
}

void main() {
  reflectPx(push, ReflectRules(kRaysOfPinholes, false, kColorRgba8, false));
}
