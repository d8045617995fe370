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

// Opaque 8-bit colour is blended in light that is nearly linear: a cubic of the code without the
// curve's toe, whose inverse is a cubic of its root. That takes half the operations of the sRGB
// fits, for each of twelve channels a ray. Codes survive unchanged (the inverse is within 0.14 of
// one), and a blend, before it is rounded, differs from that in linear light by less than two
// codes, by 0.33 in the mean over all pairs and weights. Light is 0..1.

// `rgb`: codes 0..255 in the low three bytes.
vec3 lightFromCodes(uint rgb) {
  const vec3 code = vec3(rgb & 255u, (rgb >> 8) & 255u, (rgb >> 16) & 255u);
  return ((2.4726537e-08 * code + 8.366013e-06) * code + 1.8039216e-04) * code;
}

vec3 codesFromLight(vec3 light) {
  const vec3 root = sqrt(light + 0.00078);
  return ((33.135467 * root - 111.46330) * root + 342.96448) * root - 9.6227989;
}

// Codes 0..255 before they are rounded.
vec3 codesFromLinear(vec3 light) {
  const vec3 clipped = clamp(light, 0.0, 1.0);
  const vec3 root = sqrt(clipped);
  const vec3 curve =
      ((((131.81537 * root - 413.74127) * root + 517.73502) * root - 357.54774) * root +
       387.04785) *
          root -
      10.2261349;
  return mix(curve, clipped * (12.92 * 255.0), lessThanEqual(clipped, vec3(0.0031308)));
}

const uint kOpaqueCode = 0xff000000u;  // alpha 255

// Red in the low byte.
uint packCodes(vec3 codes) {
  const uvec3 code = uvec3(codes + 0.5);
  return code.x | (code.y << 8) | (code.z << 16) | kOpaqueCode;
}

#endif  // VIEWLOOM_LIB_SRGB_GLSL_
