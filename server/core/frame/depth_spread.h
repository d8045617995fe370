// SPDX-License-Identifier: Apache-2.0
// Histogram of the pixels of a source over depth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace viewloom {

// Number of pixels with 1/Z in [inv_z_low, inv_z_high), 1/m. Infinity is in the bin that begins at
// 0.
struct DepthBin {
  double inv_z_low = 0;
  double inv_z_high = 0;
  uint32_t count = 0;
};

// Bins from far to near, which may have gaps between them. None is empty.
using DepthSpread = std::vector<DepthBin>;

// Spread from `counts` of bins. `start_of(bin)` is the smallest 1/Z of a bin, 1/m.
template <typename StartOf>
DepthSpread depthSpread(std::span<const uint32_t> counts, const StartOf& start_of) {
  DepthSpread spread;
  for (uint32_t bin = 0; bin < counts.size(); ++bin) {
    if (counts[bin] == 0) continue;
    spread.push_back(
        {.inv_z_low = start_of(bin), .inv_z_high = start_of(bin + 1), .count = counts[bin]});
  }
  return spread;
}

}  // namespace viewloom
