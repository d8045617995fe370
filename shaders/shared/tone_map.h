// SPDX-License-Identifier: Apache-2.0
// How light brighter than white comes into 0..1.
//
// The curve has a film's toe and shoulder: x^n / (x^n + k), a logistic curve of log2 x (Naka and
// Rushton, "S-potentials from colour units in the retina of fish", 1966), raised so that kToneWhite
// becomes 1. k follows from middle grey, 0.18, which stays: 0.82 0.18^n / (0.18 - (0.18 /
// white)^n). There the curve is as steep as the scene, in stops: 0.82 n = 1.025.
//
// kToneMapAgx follows the plan of T. Sobotka's AgX (2022), not its numbers: the curve acts on
// primaries that are drawn in towards white, as a share of each channel goes to both others, and
// afterwards as much is taken back as leaves no channel below 0. So a bright primary brings its
// neighbours along, smoothly from black on, and ends in white.
//
// A primary's channels go into the curve as 1 - 2 s to s, s = kToneInset. The curve is steepest,
// and they lie furthest apart behind it, in the dark: q = (s / (1 - 2 s))^n of the brightest is
// left of the others. Taking a share t of the differences to both others back leaves them
// (1 + t) q - t: none below 0 for t = q / (1 - q), which is kToneOutset.
#ifndef VIEWLOOM_SHADERS_SHARED_TONE_MAP_H_
#define VIEWLOOM_SHADERS_SHARED_TONE_MAP_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kToneMapClip = 0u;
VIEWLOOM_ABI_CONST uint kToneMapFilmic = 1u;
VIEWLOOM_ABI_CONST uint kToneMapAgx = 2u;

VIEWLOOM_ABI_CONST float kTonePower = 1.25f;
VIEWLOOM_ABI_CONST float kToneWhite = 16.0f;                    // 6.5 stops above middle grey
VIEWLOOM_ABI_CONST float kToneHalf = 0.5452092f;                // k
VIEWLOOM_ABI_CONST float kToneGain = 1.0f + kToneHalf / 32.0f;  // 32 = white^n
VIEWLOOM_ABI_CONST float kToneInset = 0.15f;       // of each channel, to each of the others
VIEWLOOM_ABI_CONST float kToneOutset = 0.170674f;  // of the same, taken back

// 0 or more to 0..1.
VIEWLOOM_ABI_FUNCTION float toneCurve(float light) {
  const float seen = light < kToneWhite ? light : kToneWhite;
  const float power = pow(seen > 0.0f ? seen : 0.0f, kTonePower);
  return kToneGain * power / (power + kToneHalf);
}

VIEWLOOM_ABI_FUNCTION vec3 toneCurves(vec3 light) {
  return vec3(toneCurve(light.x), toneCurve(light.y), toneCurve(light.z));
}

// Moves `share` of each channel to each of the others.
VIEWLOOM_ABI_FUNCTION vec3 mixChannels(vec3 light, float share) {
  const float sum = light.x + light.y + light.z;
  const float own = 1.0f - 3.0f * share;
  return vec3(own * light.x + share * sum, own * light.y + share * sum,
              own * light.z + share * sum);
}

VIEWLOOM_ABI_FUNCTION float clipLight(float light) {
  return light < 1.0f ? (light > 0.0f ? light : 0.0f) : 1.0f;
}

// Linear light of BT.709, not premultiplied, to 0..1.
VIEWLOOM_ABI_FUNCTION vec3 toneMapped(vec3 light, uint tone_map) {
  vec3 mapped = light;
  if (tone_map == kToneMapFilmic) mapped = toneCurves(light);
  if (tone_map == kToneMapAgx) {
    mapped = mixChannels(toneCurves(mixChannels(light, kToneInset)), -kToneOutset);
  }
  return vec3(clipLight(mapped.x), clipLight(mapped.y), clipLight(mapped.z));
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_TONE_MAP_H_
