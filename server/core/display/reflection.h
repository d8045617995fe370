// SPDX-License-Identifier: Apache-2.0
// What a display shows of what surfaces mirror.
#pragma once

#include <cstdint>

#include "base/status.h"
#include "display/lens.h"

namespace viewloom {

struct ReflectionSpec {
  uint32_t bounce_count = 0;     // along one ray, 1..4; 0 = of the quality
  uint32_t sample_count = 0;     // rays a px of a rough surface, 1..64; 0 = of the quality
  uint32_t environment_rgb = 0;  // 0xRRGGBB, sRGB
  bool is_filtered = true;       // samples are smoothed over neighbouring px

  bool operator==(const ReflectionSpec&) const = default;
};

inline constexpr uint32_t kBounceCountMax = 4;
inline constexpr uint32_t kReflectionSampleCountMax = 64;

// Checks every range and fills in defaults. Errors name the field as in proto ReflectionEffect.
absl::Status completeReflection(ReflectionSpec& reflection, Quality quality);

}  // namespace viewloom
