// SPDX-License-Identifier: Apache-2.0
// How light becomes the numbers that are compared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace viewloom {

enum class ScoreTransfer : uint8_t { kSrgb, kGamma22 };

// IEC 61966-2-1, for one channel of 0..1.
inline double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// An sRGB-encoded sample (0..1) in the transfer that is scored, and what is scored as light.
inline float scoredSample(float srgb_encoded, ScoreTransfer transfer) {
  if (transfer == ScoreTransfer::kSrgb) return srgb_encoded;
  return static_cast<float>(std::pow(std::max(linearFromSrgb(srgb_encoded), 0.0), 1 / 2.2));
}
inline double linearFromScored(double scored, ScoreTransfer transfer) {
  return transfer == ScoreTransfer::kSrgb ? linearFromSrgb(scored) : std::pow(scored, 2.2);
}

}  // namespace viewloom
