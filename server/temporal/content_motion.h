// SPDX-License-Identifier: Apache-2.0
// Whether what a source shows stands in the world, goes where the source's camera goes, or moves by
// itself.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

enum class ContentMotion : uint8_t {
  kUnclear,     // both would look much the same
  kStands,      // another camera of the same world
  kWithCamera,  // a thing that has a camera of its own
};

// From how depth of the source's first layer changed from one frame to the next while its camera
// moved: as seen from elsewhere, or not at all. Both frames have the source; cube maps and sources
// of another size or shape than before are unclear. Looks at kComparedSamplesMax samples.
inline constexpr uint32_t kComparedSamplesMax = 4096;
ContentMotion contentMotion(const Frame& before, const Frame& now, size_t source);

// Surfaces of the source move by themselves: it has a plane of motion.
bool movesByItself(const Frame& frame, size_t source);
// Those of some source do.
bool movesByItself(const Frame& frame);

}  // namespace viewloom
