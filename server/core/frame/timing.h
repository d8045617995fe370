// SPDX-License-Identifier: Apache-2.0
// Relation of the time that an atlas shows to the frames it was made of.
#pragma once

#include <cstdint>

namespace viewloom {

// See proto viewloom.v1.Timing.
enum class Timing : uint8_t { kCaptured, kPredicted, kInterpolated, kHeld };

// Name in JSON: "captured", "predicted", "interpolated" or "held".
inline const char* timingText(Timing timing) {
  switch (timing) {
    case Timing::kCaptured:
      return "captured";
    case Timing::kPredicted:
      return "predicted";
    case Timing::kInterpolated:
      return "interpolated";
    case Timing::kHeld:
      return "held";
  }
  return "";
}

}  // namespace viewloom
