// SPDX-License-Identifier: Apache-2.0
// Doubts about the depth and the colour of a layer.
#pragma once

#include <string>
#include <vector>

#include "inspect/depth_samples.h"
#include "inspect/measure_depth.h"

namespace viewloom::inspect {

struct Suspicion {
  // "empty", "inside-out", "flat", "clipped", "bits", "scattered", "quantised", "noisy", "scale",
  // "nothing", "bad", "alpha", "shape", "upside-down"
  std::string kind;
  std::string sentence;  // what was seen
  std::string remedy;    // what was tried on the data and helps; "" = nothing is known
};

struct DepthFacts {
  const v1::Plane& plane;
  uint32_t code_max;  // of whole numbers; 0 = floats
  const DepthSamples& samples;
  const DepthMeasures& measures;
  bool is_cube_map = false;  // six views, one below the other
};

// Rules, none of which is a proof:
//   empty       no surface in more than half of the px
//   inside-out  a sign that near and far are swapped (arrangement.h), in one view
//   flat        98 % of surfaces within a hundredth of each other in 1/Z, and no sky
//   clipped     a hundredth of surfaces at the largest code that the file has room for, or at 0,
//               unless that is the far end of inverse depth; or a twentieth at the largest number
//               beyond 100 m, where no wall fills a view exactly
//   bits        16-bit codes end where 10, 12, 14 or 15 bits do; or all are 8-bit codes stretched
//               to 16. Of metres only where their unit is unlikely
//   scattered   0 is infinitely far by the format, but lies scattered over the picture
//   quantised   half a step moves things by more than 0.25 px on a wide display, and slopes have
//               steps; fewer than 16 steps are none, but surfaces that end before others
//   noisy       the noise does so by more than a px
//   scale       the median lies beyond 200 m or nearer than 2 cm
//   nothing     numbers of 1e9 and more, unless they are said to be no surface or far
//   bad         NaN or negative in more than a hundredth
std::vector<Suspicion> suspectDepth(const DepthFacts& facts);

// How transparent a colour plane is where there is a surface.
struct AlphaMeasures {
  uint64_t surface_count = 0;
  uint64_t transparent_count = 0;  // alpha of almost 0 ...
  uint64_t lit_count = 0;          // ... though colour is not black
  bool is_ignored = true;          // opaque by declaration, or without alpha
};
AlphaMeasures measureAlpha(const v1::Plane& color, const std::vector<uint8_t>& bytes,
                           const DepthSamples& samples);

// alpha       views see through almost everything; or a twentieth of the surfaces has premultiplied
//             colour without any alpha, which only adds light
std::vector<Suspicion> suspectAlpha(const v1::Plane& color, const AlphaMeasures& measures);

// shape       colour and depth have sides of different proportions
std::vector<Suspicion> suspectShapes(const v1::SizePx& color, const v1::SizePx& depth);

}  // namespace viewloom::inspect
