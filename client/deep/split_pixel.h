// SPDX-License-Identifier: Apache-2.0
// One deep pixel to the few layers that viewloom traces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "deep/deep_sample.h"
#include "deep/partition.h"

namespace viewloom::deep {

struct SplitPixel {
  uint32_t layer_count = 0;
  std::array<DeepPoint, kGroupsMax> layers{};  // nearest first
  bool is_merged = false;                      // more points than layers
  double error_per_m = 0;                      // 1/m, see partitionPoints; 0 if it is not merged
};

// Composited with `over`, the layers are the points' composite, whatever was merged.
// Thread-safety: none; keeps its memory from pixel to pixel.
class PixelSplitter {
 public:
  explicit PixelSplitter(uint32_t layer_count_max) : layer_count_max_(layer_count_max) {}

  // points: nearest first, each with presence > 0. Points within a thousandth of the nearest one's
  // 1/Z are one; of more than kPointsMax that leaves, those within twice as much, and so on.
  SplitPixel split(std::span<const DeepPoint> points);

 private:
  void joinClose(std::span<const DeepPoint> points, double share);

  uint32_t layer_count_max_;
  std::vector<DeepPoint> distinct_;
};

}  // namespace viewloom::deep
