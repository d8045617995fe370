// SPDX-License-Identifier: Apache-2.0
// Depth samples of one layer to inv_z. Bad samples are no surface, and counted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(constant_id = kOwnConstants) const uint kSampleType = kDepthSampleF32;
layout(push_constant, scalar) uniform Push { LinearisePush push; };

layout(set = 0, binding = kBindingSamples, scalar) readonly buffer Samples32 {
  float samples_32[];
};
layout(set = 0, binding = kBindingSamples, scalar) readonly buffer Samples16 {
  uint16_t samples_16[];
};

float loadSample(uint index) {
  if (kSampleType == kDepthSampleF32) {
    return kReadByAddress ? FloatRef(push.samples).at[index] : samples_32[index];
  }
  const uint bits = uint(kReadByAddress ? Uint16Ref(push.samples).at[index] : samples_16[index]);
  return kSampleType == kDepthSampleF16 ? unpackHalf2x16(bits).x : float(bits);
}

// inv_z, kNoSurface, or NaN for a bad sample (frame/depth.h linearizeDepth is the reference).
float linearise(float depth_sample, float ray_length) {
  if (push.has_invalid != 0u && depth_sample == push.invalid_value) {
    return push.invalid_is_far != 0u ? 0.0 : kNoSurface;
  }
  const float bad = uintBitsToFloat(0x7fc00000u);
  const float value = (depth_sample - push.origin) * push.scale + push.offset;
  if (!(value >= 0.0)) return bad;
  if (push.reciprocal == 0u) return value <= push.inv_z_max ? value : bad;
  if (value == 0.0) return kNoSurface;
  const float inv_z = (isinf(value) ? 0.0 : 1.0 / value) * ray_length;
  return inv_z <= push.inv_z_max ? inv_z : bad;
}

void main() {
  const uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= push.width_px || pixel.y >= push.height_px) return;
  const uint index = pixel.y * push.width_px + pixel.x;
  const vec2 principal_px = vec2(push.principal_x_px, push.principal_y_px);
  const vec2 ray = (vec2(pixel) + 0.5 - principal_px) / vec2(push.focal_x_px, push.focal_y_px);
  const float ray_length = push.ray_distance != 0u ? length(vec3(ray, 1.0)) : 1.0;
  const float inv_z = linearise(loadSample(index), ray_length);
  storeInvZ(push.inv_z, push.layer, push.width_px * push.height_px, index,
            inv_z >= 0.0 ? inv_z : kNoSurface);
  MeasuredRef measured = MeasuredRef(push.measured);
  if (isnan(inv_z)) atomicAdd(measured.value.head.bad_samples_count, 1u);
}
