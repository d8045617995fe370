// SPDX-License-Identifier: Apache-2.0
// Which px of a view a source can know, exactly: in which of its layers lies what they see.
#pragma once

#include <cstdint>
#include <vector>

#include "support/truth/picture.h"

namespace viewloom::truth {

// Values below kLayersMax are layers of the source.
enum Known : uint8_t {
  kDeeper = kLayersMax,  // behind so many others that no layer of a source holds it
  kFacingAway,           // it faces away from the source
  kOutside,              // not in the source's image
  kEmpty,                // there is nothing
  kKnownCount
};

// Knowledge about the hit of any ray.
uint8_t knownAlong(const Instant& instant, const Camera& source, SizePx source_px, const Ray& ray);

// Knowledge about the hit of the ray through each px's centre: [height][width], top row first.
std::vector<uint8_t> knownFrom(const Instant& instant, const Camera& source, SizePx source_px,
                               const Camera& view, SizePx view_px);

}  // namespace viewloom::truth
