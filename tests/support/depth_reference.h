// SPDX-License-Identifier: Apache-2.0
// Meaning of one depth sample, in double precision, by proto DepthFormat: the reference for
// kernels.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

enum class DepthClass : uint8_t {
  kSurface,    // inv_z is valid; 0 is the sky
  kNoSurface,  // metric 0, or the declared invalid value
  kBad,        // NaN, negative or nearer than 1 / kInvZMax: no surface, and counted
};

struct DepthValue {
  DepthClass kind = DepthClass::kNoSurface;
  double inv_z = 0;  // 1/m
};

// One sample, as stored (U16: 0..65535), to 1/Z. Pixel counts from the top left and matters for
// kRayDistance alone, where the ray is that of the sample's centre.
DepthValue linearizeDepth(const DepthFormat& format, PlaneEncoding encoding, double sample,
                          glm::uvec2 pixel_px, const Intrinsics& intrinsics);

}  // namespace viewloom
