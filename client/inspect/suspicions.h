// SPDX-License-Identifier: Apache-2.0
// What looks wrong in the depth of a layer, each with what to do about it.
#pragma once

#include <string>
#include <vector>

#include "inspect/depth_samples.h"
#include "inspect/measure_depth.h"

namespace viewloom::inspect {

struct Suspicion {
  std::string kind;  // "inside-out", "flat", "clipped", "quantised", "noisy", "scale", "nothing",
                     // "empty", "bad", "shape"
  std::string sentence;  // what was seen, and the remedy
};

struct DepthFacts {
  const v1::Plane& plane;
  uint32_t code_max;  // of whole numbers; 0 = floats
  const DepthSamples& samples;
  const DepthMeasures& measures;
};

// Rules, none of which is a proof:
//   inside-out  a fifth of the top quarter has the nearest depth of all, but not of the bottom; or
//               both the top is nearer than the bottom and the sides nearer than the middle, by
//               their medians and a tenth: skies, walls and floors lie the other way round
//   flat        98 % of surfaces within a hundredth of each other in 1/Z, and no sky
//   clipped     a hundredth of surfaces at the least or largest code, or a twentieth at the least
//               or largest number there is
//   quantised   half a step moves things by more than 0.25 px on a wide display; fewer than 32
//               steps are none, but surfaces that end before others
//   noisy       the noise does so by more than a px
//   scale       the median lies beyond 200 m or nearer than 2 cm
//   nothing     numbers of 1e9 and more, unless they are said to be far
//   empty       no surface in more than half of the px
//   bad         NaN or negative in more than a hundredth
std::vector<Suspicion> suspectDepth(const DepthFacts& facts);

// shape       colour and depth have sides of different proportions
std::vector<Suspicion> suspectShapes(const v1::SizePx& color, const v1::SizePx& depth);

}  // namespace viewloom::inspect
