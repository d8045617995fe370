// SPDX-License-Identifier: Apache-2.0
// Colour planes that are not 8-bit opaque sRGB BT.709 to what the trace blends: opaque ones to
// roots of light, others to linear BT.709, premultiplied, binary16.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "lib/light/srgb.glsl"
#include "shared/tone_map.h"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push { ConvertColorPush push; };

// RGB to RGB, both with the white point D65; from the primaries' chromaticities (SMPTE EG 432-1,
// ITU-R BT.2020, ITU-R BT.709).
const mat3 kBt709FromDisplayP3 = mat3(1.2249402, -0.0420570, -0.0196376,  //
                                      -0.2249402, 1.0420570, -0.0786361,  //
                                      0.0, 0.0, 1.0982737);
const mat3 kBt709FromBt2020 = mat3(1.6604910, -0.1245505, -0.0181508,  //
                                   -0.5876411, 1.1328999, -0.1005789,  //
                                   -0.0728499, -0.0083494, 1.1187297);

// A curve applies to the colour itself, so premultiplied light is divided first; what has light
// without covering anything is as bright as that.
vec3 toneMappedSurface(vec3 light, float alpha) {
  const float cover = push.alpha == kAlphaPremultiplied && alpha > 0.0 ? alpha : 1.0;
  return cover * toneMapped(light / cover, push.tone_map);
}

void main() {
  const uint index =
      gl_WorkGroupID.y * gl_NumWorkGroups.x * kNodeGroupSize + gl_GlobalInvocationID.x;
  if (index >= push.texel_count) return;
  vec4 texel;
  if (push.from_format == kColorRgba8) {
    texel = unpackUnorm4x8(UintRef(push.from).at[index]);
  } else {
    const uvec2 bits = Uvec2Ref(push.from).at[index];
    texel = vec4(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y));
  }
  // Not a number, or no light: black.
  const float alpha =
      push.alpha == kAlphaOpaque ? 1.0 : clamp(isnan(texel.a) ? 0.0 : texel.a, 0.0, 1.0);
  vec3 light = mix(texel.rgb, vec3(0.0), isnan(texel.rgb));
  // A transfer applies to the colour itself, so premultiplied values are divided first.
  const bool is_encoded = push.is_linear == 0u;
  if (push.alpha == kAlphaPremultiplied && is_encoded && alpha > 0.0) light /= alpha;
  if (is_encoded) light = linearFromSrgb(clamp(light, 0.0, 1.0));
  if (push.primaries == kPrimariesDisplayP3) light = kBt709FromDisplayP3 * light;
  if (push.primaries == kPrimariesBt2020) light = kBt709FromBt2020 * light;
  light *= push.light_scale;
  if (push.tone_map != kToneMapClip) light = toneMappedSurface(light, alpha);
  if (push.alpha != kAlphaPremultiplied || is_encoded) light *= alpha;
  if (push.to_format == kColorRgb16) {
    Uvec2Ref(push.to).at[index] = rgb16FromLinear(light);
    return;
  }
  // The largest binary16: brighter light would become infinite and spread.
  light = clamp(light, -65504.0, 65504.0);
  Uvec2Ref(push.to).at[index] = uvec2(packHalf2x16(light.rg), packHalf2x16(vec2(light.b, alpha)));
}
