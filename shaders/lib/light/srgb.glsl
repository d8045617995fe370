// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer (IEC 61966-2-1).
#ifndef VIEWLOOM_LIB_LIGHT_SRGB_GLSL_
#define VIEWLOOM_LIB_LIGHT_SRGB_GLSL_

// Minimax fits of the curve beyond its straight toe: within 0.06 of 1/255 when decoding, 0.09 when
// encoding (over the root of light), so 8-bit colour survives both unchanged.
vec3 linearFromSrgb(vec3 srgb) {
  const vec3 curve =
      (((-0.1167994 * srgb + 0.5265083) * srgb + 0.5603838) * srgb + 0.02840018) * srgb +
      0.001046527;
  return mix(curve, srgb * (1.0 / 12.92), lessThanEqual(srgb, vec3(0.04045)));
}

// kColorRgba8: codes 0..255.
vec3 codesOfRgba8(uint rgba) {
  return vec3(rgba & 255u, (rgba >> 8) & 255u, (rgba >> 16) & 255u);
}

// kColorRgb16: light to the power of 1 / 2.4, 0..1.
vec3 rootsOfRgb16(uvec2 rgb) {
  return vec3(unpackUnorm2x16(rgb.x), unpackUnorm2x16(rgb.y).x);
}

// kColorCodes11: codes 0..255, in parts of 11, 11 and 10 bits.
const vec3 kCodeSteps = vec3(8.0, 8.0, 4.0);

vec3 codesOfRgb11(uint rgb) {
  return vec3(rgb & 2047u, (rgb >> 11) & 2047u, rgb >> 22) / kCodeSteps;
}

uint rgb11OfCodes(vec3 codes) {
  const uvec3 steps = uvec3(codes * kCodeSteps + 0.5);
  return steps.r | (steps.g << 11) | (steps.b << 22);
}

vec3 rootsFromLinear(vec3 light) {
  return pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.4));
}

uvec2 rgb16FromRoots(vec3 root) {
  return uvec2(packUnorm2x16(root.rg), packUnorm2x16(vec2(root.b, 0.0)));
}

uvec2 rgb16FromLinear(vec3 light) {
  return rgb16FromRoots(rootsFromLinear(light));
}

// Codes 0..255 before they are rounded. The curve is 269.025 L^(1/2.4) - 14.025; the toe, 12.92 L,
// a fit that is within 0.09 of a code, and nothing at 0.
vec3 codesFromRoots(vec3 root) {
  const vec3 curve = 269.025 * root - 14.025;
  const vec3 toe = ((-66896.274 * root + 15675.502) * root + 379.52996) * root * root;
  return mix(curve, toe, lessThanEqual(root, vec3(0.0904738)));
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

#endif  // VIEWLOOM_LIB_LIGHT_SRGB_GLSL_
