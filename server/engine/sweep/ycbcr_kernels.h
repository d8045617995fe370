// SPDX-License-Identifier: Apache-2.0
// Rows of RGB to rows of Y'CbCr (shaders/shared/ycbcr.h), with the vectors of the CPU it runs on.
#pragma once

#include <cstddef>
#include <cstdint>

namespace viewloom {

// rgba[width_px]: R, G, B, ignored in memory order. `width_px` is a multiple of
// YcbcrLayout::kPadding_px; exactly as many samples are written.
void ycbcrRow444(const uint32_t* rgba, size_t width_px, uint8_t* luma, uint8_t* cb, uint8_t* cr);

// Two rows, the upper one of even index, and the one row of chroma that they share.
struct YcbcrRows420 {
  const uint32_t* upper_rgba;
  const uint32_t* lower_rgba;
  uint8_t* upper_luma;
  uint8_t* lower_luma;
  uint8_t* cb;
  uint8_t* cr;
};
void ycbcrRows420(const YcbcrRows420& rows, size_t width_px);

}  // namespace viewloom
