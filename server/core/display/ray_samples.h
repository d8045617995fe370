// SPDX-License-Identifier: Apache-2.0
// The rays that make one px of an atlas: one, or several that are spread over the px and over the
// eyes that it is seen from.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

#include "frame/camera.h"

namespace viewloom {

// Channels that a ray counts for.
inline constexpr uint8_t kRedChannel = 1;
inline constexpr uint8_t kGreenChannel = 2;
inline constexpr uint8_t kBlueChannel = 4;
inline constexpr uint8_t kAllChannels = kRedChannel | kGreenChannel | kBlueChannel;

// One of the rays of a px; by itself, that through its middle from the view's own eye.
struct RaySample {
  glm::dvec2 px{0.0};     // beside the middle of the px, right and down, px
  glm::dvec2 eye_m{0.0};  // beside the view's eye, along its axes to the right and up, m
  uint8_t channels = kAllChannels;
};

// A display's anti-alias and crosstalk filter: a px shows what is seen from the whole stretch of
// eyes up to half way to its neighbouring views.
struct RayFilter {
  uint32_t sample_count = 1;  // rays a channel; 1 = off
  double width = 1;           // of that stretch, in distances between neighbouring views
};

inline constexpr uint32_t kFilterSampleCountMax = 16;
inline constexpr double kFilterWidthMax = 4;

// `pitch_m`: between the eyes of neighbouring views, to the right and up. The samples are those of
// Roberts' R4 sequence ("The Unreasonable Effectiveness of Quasirandom Sequences", 2018), jointly
// over the px and the stretch: any few neighbours of them are spread evenly over all four axes. The
// first is that without a filter.
std::vector<RaySample> filterSamples(const RayFilter& filter, glm::dvec2 pitch_m);

// The same for displays of which each channel of a px is seen from an eye of its own: first those
// of green, then red's, then blue's.
std::vector<RaySample> channelSamples(const RayFilter& filter, glm::dvec2 pitch_m);

// The pinhole of one sample of a view: the same picture of what is `focus_m` in front of it, seen
// from beside.
Camera sampledCamera(const Camera& camera, const RaySample& sample, double focus_m);

inline constexpr double kNoFocus_m = std::numeric_limits<double>::infinity();

}  // namespace viewloom
