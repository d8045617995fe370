// SPDX-License-Identifier: Apache-2.0
// How light becomes the numbers that are compared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/srgb.h"

namespace viewloom {

enum class ScoreTransfer : uint8_t { kSrgb, kGamma22 };

// An sRGB-encoded sample (0..1) in the transfer that is scored, and what is scored as light.
inline float scoredSample(float srgb_encoded, ScoreTransfer transfer) {
  if (transfer == ScoreTransfer::kSrgb) return srgb_encoded;
  return static_cast<float>(std::pow(std::max(linearFromSrgb(srgb_encoded), 0.0), 1 / 2.2));
}
inline double linearFromScored(double scored, ScoreTransfer transfer) {
  return transfer == ScoreTransfer::kSrgb ? linearFromSrgb(scored) : std::pow(scored, 2.2);
}

}  // namespace viewloom
