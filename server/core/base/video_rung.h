// SPDX-License-Identifier: Apache-2.0
// Qualities in which a display whose quality adapts is coded at a time.
#pragma once

#include <cstdint>

namespace viewloom {

// Viewers begin on the first rung. Those whose lines are far slower may be moved to the second.
enum class VideoRung : uint8_t { kFirst, kSecond, kCount };

}  // namespace viewloom
