// SPDX-License-Identifier: Apache-2.0
// Reflected light of the pixels of a band: rays go on from where those of walk_views.comp ended,
// mirrored, and end in the same structure. An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdColorFormat) const uint kColorFormat = kColorRgba8;
layout(constant_id = kIdColorIsScaled) const bool kColorIsScaled = false;
layout(constant_id = kIdRays) const uint kRays = kRaysOfPinholes;
layout(constant_id = kIdThroughLens) const bool kThroughLens = false;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

#include "lib/mirrors/mirrored_walk.glsl"

Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected) {
  return foundBy(scene, pinhole, from, reflected.ray, walkMirrored(scene, from, reflected));
}

void main() {
  reflectPx(push, ReflectRules(kRays, kThroughLens, kColorFormat, kColorIsScaled));
}
