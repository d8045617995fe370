// SPDX-License-Identifier: Apache-2.0
// Adds what comes by way of surfaces to the px that show them. That of rough ones is a mean over
// px of the same surface near by, as far as the blur of both would mix them anyway.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "lib/light/srgb.glsl"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  AddReflectionsPush push;
};
layout(set = 0, binding = kBindingReflected, scalar) readonly buffer ReflectedBand {
  ReflectedLight reflected_band[];
};
layout(set = 0, binding = kBindingBand, scalar) buffer Band {
  uint band[];
};

#include "lib/mirrors/reflected_light.glsl"

const int kRadiusMax_px = 3;
// Share of the blur of the mirrored light: further away, pixels show different things.
const float kRadiusOfBlur = 0.5;
// By how much 1/Z and roughness of two px may differ, and the cosine between their normals.
const float kNearestShare = 0.02;
const float kRoughnessApart = 0.1;
const float kNormalsMin = 0.95;

struct Px {
  vec3 light;
  float distance_m;
  vec3 reflectance;
  float roughness;
  vec3 normal;
  float inv_z;
  float weight;  // of its light among that of others
};

Px pxAt(uint index) {
  const ReflectedLight bits = reflected_band[index];
  const float blue = unpackHalf2x16(bits.light.y).x;
  return Px(vec3(unpackHalf2x16(bits.light.x), blue),
            unpackedDistance(bits.light.y >> 16 & 0xffu), reflectanceOf(bits.reflectance),
            roughnessOf(bits.reflectance), normalOfPlace(bits.place),
            uintBitsToFloat(bits.place & 0xffff0000u), unpackedWeight(bits.light.y >> 24));
}

// How far around it a px is averaged, px of the view: half of the width that the blur of what is
// mirrored has on the surface.
float radiusOf(Px px) {
  const float alpha = px.roughness * px.roughness;
  const float behind = px.distance_m * px.inv_z;  // of the way from the eye to the surface
  return kRadiusOfBlur * alpha * push.focal_px * behind / (1.0 + behind);
}

// Rows and columns of the same view that are filtered together.
struct Window {
  ivec2 low;
  ivec2 high;
};

Window windowOf(ivec2 px) {
  const ivec2 tile_size = ivec2(push.tile_size_px & 0xffffu, push.tile_size_px >> 16);
  const int first_row = int(push.first_row);
  const int top = int(push.padding_top_px);
  const int tile_column = px.x / tile_size.x;
  const int tile_row = (px.y + first_row - top) / tile_size.y;
  const int rows = int(kFilterRows);
  const ivec2 low = ivec2(tile_column * tile_size.x, top + tile_row * tile_size.y - first_row);
  const ivec2 high = low + tile_size - 1;
  const int group = px.y / rows * rows;
  return Window(max(low, ivec2(0, group)),
                min(high, ivec2(high.x, min(group + rows, int(push.row_count)) - 1)));
}

vec3 filtered(ivec2 at, Px own) {
  const float radius = min(radiusOf(own), float(kRadiusMax_px));
  if (push.is_filtered == 0u || radius < 0.5) return own.light;
  const Window window = windowOf(at);
  const ivec2 reach = ivec2(int(radius + 0.5));
  const ivec2 low = max(at - reach, window.low);
  const ivec2 high = min(at + reach, window.high);
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const Px other = pxAt(uint(y) * push.atlas_width_px + uint(x));
      // Sharp light reaches no further into blurred light than its own blur.
      const float narrower = min(radius, radiusOf(other));
      const vec2 apart = vec2(ivec2(x, y) - at) / (narrower + 0.5);
      const float near = max(1.0 - dot(apart, apart), 0.0);
      const bool is_mirror = any(greaterThan(other.reflectance, vec3(0.0)));
      const bool is_alike =
          is_mirror && abs(other.inv_z - own.inv_z) <= kNearestShare * own.inv_z &&
          abs(other.roughness - own.roughness) <= kRoughnessApart &&
          dot(other.normal, own.normal) >= kNormalsMin;
      const float weight = is_alike ? near * other.weight : 0.0;
      sum += weight * other.light;
      weights += weight;
    }
  }
  return weights > 0.0 ? sum / weights : own.light;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  if (at.x >= int(push.atlas_width_px)) return;
  const uint index = uint(at.y) * push.atlas_width_px + uint(at.x);
  const Px own = pxAt(index);
  if (all(lessThanEqual(own.reflectance, vec3(0.0)))) return;
  const vec3 added = own.reflectance * filtered(at, own);
  const bool has_linear = push.linear != uvec2(0u);
  const vec3 shown =
      has_linear ? Vec4Ref(push.linear).at[index].rgb : codesOfRgba8(band[index]) / 255.0;
  const vec3 codes = codesFromLinear(linearFromSrgb(shown) + added);
  band[index] = packCodes(codes);
  if (has_linear) Vec4Ref(push.linear).at[index] = vec4(clamp(codes / 255.0, 0.0, 1.0), 1.0);
}
