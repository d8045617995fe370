// SPDX-License-Identifier: Apache-2.0
// A card of colours and shapes, flat on the focal plane.
#pragma once

#include <array>
#include <string_view>

#include "patterns/canvas.h"
#include "patterns/pattern.h"

namespace viewloom::patterns {

// Colours that leave a decoder as they are here, 255 or 0 in each channel, in this order.
inline constexpr std::array<Rgb, 8> kCardColors = {{{255, 255, 255},
                                                    {255, 255, 0},
                                                    {0, 255, 255},
                                                    {0, 255, 0},
                                                    {255, 0, 255},
                                                    {255, 0, 0},
                                                    {0, 0, 255},
                                                    {0, 0, 0}}};
inline constexpr uint32_t kGreySteps = 11;       // black to white, equal steps of the code
inline constexpr uint32_t kLinePairsMax_px = 4;  // pairs of lines of 1 to so many px
inline constexpr Rgb kCardPaper = {128, 128, 128};

// Whole px of the source.
struct CardPlaces {
  std::array<PxBox, kCardColors.size()> colors;
  std::array<PxBox, kGreySteps> grey_steps;
  PxBox ramp;  // the code grows by one with each px, or every second ...
  std::array<PxBox, kLinePairsMax_px> upright_lines;  // white where x - left is in the first half
  std::array<PxBox, kLinePairsMax_px> level_lines;    // of a pair, as is y - top
};

CardPlaces cardPlaces(SizePx size_px);

absl::StatusOr<Pattern> drawCard(const PatternOptions& options);

}  // namespace viewloom::patterns
