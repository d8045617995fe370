// SPDX-License-Identifier: Apache-2.0
#include "deep/split_pixel.h"

namespace viewloom::deep {
namespace {

// Of 1/Z: a twentieth of the step that the server takes for one surface, and far more than a step
// of binary16 depth at which it would take two layers for the same.
constexpr double kCloseShare = 1.0 / 1024;

}  // namespace

void PixelSplitter::joinClose(std::span<const DeepPoint> points, double share) {
  distinct_.clear();
  for (size_t begin = 0; begin < points.size();) {
    const double least_inv_z = (1 - share) * points[begin].inv_z;
    size_t end = begin + 1;
    while (end < points.size() && points[end].inv_z >= least_inv_z) ++end;
    distinct_.push_back(joined(points.subspan(begin, end - begin)));
    begin = end;
  }
}

SplitPixel PixelSplitter::split(std::span<const DeepPoint> points) {
  // Ends: from a share of 1 on, all points are close.
  for (double share = kCloseShare;; share *= 2) {
    joinClose(points, share);
    if (distinct_.size() <= kPointsMax) break;
  }
  SplitPixel pixel;
  const std::span<const DeepPoint> distinct = distinct_;
  if (distinct.size() <= layer_count_max_) {
    pixel.layer_count = static_cast<uint32_t>(distinct.size());
    for (size_t i = 0; i < distinct.size(); ++i) pixel.layers[i] = distinct[i];
    return pixel;
  }
  const Partition partition = partitionPoints(distinct, layer_count_max_);
  pixel.layer_count = partition.group_count;
  pixel.is_merged = true;
  pixel.error_per_m = partition.error_per_m;
  size_t begin = 0;
  for (uint32_t g = 0; g < partition.group_count; ++g) {
    pixel.layers[g] = joined(distinct.subspan(begin, partition.ends[g] - begin));
    begin = partition.ends[g];
  }
  return pixel;
}

}  // namespace viewloom::deep
