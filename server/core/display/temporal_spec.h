// SPDX-License-Identifier: Apache-2.0
// Atlases between the frames of a stream, at a display's own rate.
#pragma once

#include <cstdint>

#include "base/status.h"

namespace viewloom {

enum class TemporalMode : uint8_t { kPredict, kInterpolate };

// As proto TemporalEffect.
struct TemporalSpec {
  double output_rate_hz = 0;
  TemporalMode mode = TemporalMode::kPredict;
  double bridge_s = 0;  // 0 = kDefaultBridge_s

  bool operator==(const TemporalSpec&) const = default;
};

inline constexpr double kOutputRateMin_hz = 1;
inline constexpr double kOutputRateMax_hz = 240;
inline constexpr double kBridgeMax_s = 10;
inline constexpr double kDefaultBridge_s = 0.25;

// Checks the ranges and fills in the default. Errors name the field as in proto Display.
absl::Status complete(TemporalSpec& temporal);

}  // namespace viewloom
