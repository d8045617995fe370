// SPDX-License-Identifier: Apache-2.0
// Scores of a picture apart for what the source knows and what had to be made up.
#pragma once

#include <cstdint>
#include <span>

#include "scoring/image_score.h"

namespace viewloom {

// Whether a pixel of a view can be known from the source: covered by what it shows, hidden behind
// that, or outside its image.
enum class PixelClass : uint8_t { kHidden, kOutside, kCovered };

struct ClassScores {
  ImageScore covered;
  ImageScore hidden;
  ImageScore outside;
  ImageScore all;
};

// classes: PixelClass[height][width] of the pictures compared.
ClassScores scoreByClass(const ImageComparison& comparison, std::span<const PixelClass> classes);

}  // namespace viewloom
