// SPDX-License-Identifier: Apache-2.0
// How the time that an atlas shows stands to the frames it was made of.
#pragma once

#include <cstdint>

namespace viewloom {

// As proto viewloom.v1.Timing.
enum class Timing : uint8_t { kCaptured, kPredicted, kInterpolated, kHeld };

}  // namespace viewloom
