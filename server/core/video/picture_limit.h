// SPDX-License-Identifier: Apache-2.0
// Largest pictures of H.264.
#pragma once

#include <cstdint>

#include "frame/size.h"

namespace viewloom {

// Largest picture of H.264 up to level 5.1, which is also OpenH264's limit.
inline constexpr uint64_t kVideoAreaMax_px = 9'437'184;

// Limit of a level, or of an encoder. Pictures are counted in whole macroblocks of 16x16 px.
struct PictureLimit {
  uint64_t area_max_px = kVideoAreaMax_px;
  uint32_t side_max_px = 16384;  // further limit of a device

  // A side has at most sqrt(8 MaxFS) macroblocks (A.3.1 f and g).
  constexpr bool holds(SizePx size_px) const {
    constexpr uint64_t kMacroblock_px = 16;
    const uint64_t width_mb = (size_px.width + kMacroblock_px - 1) / kMacroblock_px;
    const uint64_t height_mb = (size_px.height + kMacroblock_px - 1) / kMacroblock_px;
    const uint64_t count_max = area_max_px / (kMacroblock_px * kMacroblock_px);
    return width_mb * height_mb <= count_max && width_mb * width_mb <= 8 * count_max &&
           height_mb * height_mb <= 8 * count_max && size_px.width <= side_max_px &&
           size_px.height <= side_max_px;
  }
};

// Largest picture of level 6.2.
inline constexpr uint64_t kVideoAreaOfLevel6_px = uint64_t{139264} * 256;

}  // namespace viewloom
