// SPDX-License-Identifier: Apache-2.0
// Rays of one pixel of an atlas: one ray, or several that are spread over the pixel and over eyes.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

#include "frame/camera.h"

namespace viewloom {

// Colour channels that a ray counts for.
inline constexpr uint8_t kRedChannel = 1;
inline constexpr uint8_t kGreenChannel = 2;
inline constexpr uint8_t kBlueChannel = 4;
inline constexpr uint8_t kAllChannels = kRedChannel | kGreenChannel | kBlueChannel;

// One ray of a pixel. By default it passes through the middle of the pixel from the view's eye.
struct RaySample {
  glm::dvec2 px{0.0};     // from the middle of the pixel, right and down, px
  glm::dvec2 eye_m{0.0};  // from the view's eye, along its axes to the right and up, m
  uint8_t channels = kAllChannels;
};

// Filter against aliasing and crosstalk. A pixel shows the mean of what is seen from all eyes up to
// half way to the neighbouring views.
struct RayFilter {
  uint32_t sample_count = 1;  // rays a channel; 1 = off
  double width = 1;           // range of eyes, in distances between neighbouring views
};

inline constexpr uint32_t kFilterSampleCountMax = 16;
inline constexpr double kFilterWidthMax = 4;

// Samples of a filter. `pitch_m` is the distance between eyes of neighbouring views, right and up.
// They are points of Roberts' R4 sequence ("The Unreasonable Effectiveness of Quasirandom
// Sequences", 2018) over the pixel and the range of eyes. Any few consecutive ones are spread
// evenly over all four axes. The first is the ray without a filter.
std::vector<RaySample> filterSamples(const RayFilter& filter, glm::dvec2 pitch_m);

// The same for displays where each channel of a pixel has its own eye: samples of green, then of
// red, then of blue.
std::vector<RaySample> channelSamples(const RayFilter& filter, glm::dvec2 pitch_m);

// Pinhole camera of one sample of a view. It stands beside the view and shows the same picture of
// the plane `focus_m` in front of it.
Camera sampledCamera(const Camera& camera, const RaySample& sample, double focus_m);

inline constexpr double kNoFocus_m = std::numeric_limits<double>::infinity();

}  // namespace viewloom
