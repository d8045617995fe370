// SPDX-License-Identifier: Apache-2.0
// One deep pixel to the few layers that viewloom traces, by the best way to group points that lie
// behind each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "deep/deep_sample.h"

namespace viewloom::deep {

inline constexpr uint32_t kGroupsMax = 4;   // as many layers a frame may have
inline constexpr uint32_t kPointsMax = 64;  // that are partitioned

// How much of the pixel a point is where nothing lies before it: its alpha, or its light where that
// is more (fire has no alpha).
double presence(const DeepPoint& point);

// Points of one group composited with `over`. Its 1/Z is the mean of theirs by presence times
// transmittance of what the group has before them: by what each contributes to the group.
DeepPoint joined(std::span<const DeepPoint> group);

// Consecutive groups: group g ends before point ends[g].
struct Partition {
  uint32_t group_count = 0;
  std::array<uint32_t, kGroupsMax> ends{};
  double error_per_m = 0;  // 1/m
};

// The partition into at most group_count_max groups that has the least occlusion error: the sum
// over all points of weight * |1/Z - 1/Z of its group|, where the weight is presence times
// transmittance of all that lies before it, but at least a sixteenth of the presence: what is
// hidden here may be seen by another view. Times focal length (px) and the way (m) of an eye to
// the side, the error of one point is by how many px it is seen in the wrong place.
//
// Exact: by dynamic programming over the last point of each group, O(group_count_max n^2).
// points: 1..kPointsMax, 1/Z never increasing.
Partition partitionPoints(std::span<const DeepPoint> points, uint32_t group_count_max);

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
