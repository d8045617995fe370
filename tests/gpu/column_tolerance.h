// SPDX-License-Identifier: Apache-2.0
// How far columns of the device may lie from those of the sweep.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "frame/frame.h"
#include "shared/structure_abi.h"
#include "sweep/depth_columns.h"

namespace viewloom {

// Shares of 1/Z that the device may round otherwise than the sweep. Window depth and disparity are
// made of sums and products alone, which both round alike. Else quotients differ, by Vulkan's
// "Precision and Operation of SPIR-V Instructions":
// - Planar: 2.5 ulp of the device's quotient, and 0.5 of the sweep's.
// - Ray distance: the device has a quotient more for the root (2.5, and 2 of the inverse root), two
//   for the ray at half their effect on its squared length (2.5), and roundings of 1.25. The
//   sweep's product with a rounded 1 / focal, its root and its other roundings are 2.75.
// A software device rounds quotients and roots nearly as the sweep does.
inline constexpr double kUlp = 1.0 / (1 << 23);  // of a number that begins an octave
inline constexpr double kPlanarShare = (2.5 + 0.5) * kUlp;
inline constexpr double kRayShare = kPlanarShare + (2.5 + 2 + 2.5 + 1.25 + 2.75) * kUlp;
inline constexpr double kSoftwarePlanarShare = kUlp;
inline constexpr double kSoftwareRayShare = 3 * kUlp;
// Measured depths and steps, and bounds of planes.
inline constexpr double kStatsShare = 4 * kUlp;

// A pass of smoothing moves a px by an eighth of each of four pairs. What a pair gives changes by
// twice what its px differ by at most, so differences double; roundings of both sides add 3 ulp.
inline constexpr double kPassGain = 2;
inline constexpr double kPassShare = 3 * kUlp;
// Pairs that give anything lie no further from the px, in reaches: they bend by less than
// kPairReaches, and rise by less than that to either side of their middle.
inline constexpr double kPairSpan = 1.5 * double{abi::kPairReaches};

// Two values are apart by at most `share` of the larger one and `reach` together.
struct ColumnTolerance {
  double share = 0;
  double reach = 0;  // 1/m

  bool holds(float a, float b) const {
    // A zero with a sign would be taken for a facet with a link.
    if (std::signbit(a) != std::signbit(b)) return false;
    return std::abs(double{a} - double{b}) <= at(std::max(std::abs(a), std::abs(b)));
  }
  double at(double inv_z) const { return share * (inv_z + reach); }
};

inline bool hasLayer(const Frame& frame, DepthMeaning meaning) {
  const std::vector<LayerFormat>& layers = frame.format.sources[0].layers;
  return std::any_of(layers.begin(), layers.end(), [&](const LayerFormat& layer) {
    return layer.depth.depth.meaning == meaning;
  });
}

inline double shareOfSamples(const Frame& frame, bool is_software) {
  if (hasLayer(frame, DepthMeaning::kRayDistance))
    return is_software ? kSoftwareRayShare : kRayShare;
  if (!hasLayer(frame, DepthMeaning::kPlanar)) return 0;
  return is_software ? kSoftwarePlanarShare : kPlanarShare;
}

inline ColumnTolerance toleranceOf(const Frame& frame, const Smoothing& smoothing,
                                   bool is_software) {
  const double share = shareOfSamples(frame, is_software);
  if (share == 0 || smoothing.reach == 0) return {.share = share};
  const double pass_count = double{abi::kSmoothingPassCount} - smoothing.first_pass;
  return {.share = std::pow(kPassGain, pass_count) * (share + kPassShare),
          .reach = pass_count * kPairSpan * double{smoothing.reach}};
}

}  // namespace viewloom
