// SPDX-License-Identifier: Apache-2.0
// Adds up samples of the px of rows, as light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace viewloom {

// Sums of light for one row of several tiles. Thread-safety: none; one a thread.
class LightSums {
 public:
  // Nothing is added yet.
  void begin(uint32_t tile_count, uint32_t width_px);
  // Codes of sRGB, R, G, B, ignored, width_px of them.
  void add(uint32_t tile, const uint32_t* rgba);
  // The mean of `count` samples as codes, alpha 255.
  void mean(uint32_t tile, uint32_t count, uint32_t* rgba) const;

 private:
  uint32_t width_px_ = 0;
  std::vector<float> sums_;  // [tile][px][R, G, B], linear light
};

}  // namespace viewloom
