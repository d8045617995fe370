// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer (IEC 61966-2-1).
#ifndef VIEWLOOM_LIB_SRGB_GLSL_
#define VIEWLOOM_LIB_SRGB_GLSL_

// Minimax fits of the curve beyond its straight toe: within 0.06 of 1/255 when decoding, 0.09 when
// encoding (over the root of light), so 8-bit colour survives both unchanged.
vec3 linearFromSrgb(vec3 srgb) {
  const vec3 curve =
      (((-0.1167994 * srgb + 0.5265083) * srgb + 0.5603838) * srgb + 0.02840018) * srgb +
      0.001046527;
  return mix(curve, srgb * (1.0 / 12.92), lessThanEqual(srgb, vec3(0.04045)));
}

// The same fit for 8-bit codes, 0..255, in the low three bytes: coefficient k over 255^k, which
// saves the walk a division for each of its twelve channels.
vec3 linearFromSrgb8(uint rgb) {
  const vec3 code = vec3(rgb & 255u, (rgb >> 8) & 255u, (rgb >> 16) & 255u);
  const vec3 curve =
      (((-2.7623575e-11 * code + 3.1752994e-08) * code + 8.6179746e-06) * code + 0.00011137325) *
          code +
      0.001046527;
  return mix(curve, code * (1.0 / (12.92 * 255.0)), lessThanEqual(code, vec3(0.04045 * 255.0)));
}

vec3 srgbFromLinear(vec3 light) {
  const vec3 clipped = clamp(light, 0.0, 1.0);
  const vec3 root = sqrt(clipped);
  const vec3 curve =
      ((((0.5169230 * root - 1.6225148) * root + 2.0303334) * root - 1.4021480) * root +
       1.5178347) *
          root -
      0.04010249;
  return mix(curve, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
}

// To 8-bit codes, rounded, with alpha 255: the same fit times 255, and a half to round.
uint srgb8FromLinear(vec3 light) {
  const vec3 clipped = clamp(light, 0.0, 1.0);
  const vec3 root = sqrt(clipped);
  const vec3 curve =
      ((((131.81537 * root - 413.74127) * root + 517.73502) * root - 357.54774) * root +
       387.04785) *
          root -
      9.7261349;
  const vec3 toe = clipped * (12.92 * 255.0) + 0.5;
  const uvec3 code = uvec3(mix(curve, toe, lessThanEqual(clipped, vec3(0.0031308))));
  return code.x | (code.y << 8) | (code.z << 16) | 0xff000000u;
}

#endif  // VIEWLOOM_LIB_SRGB_GLSL_
