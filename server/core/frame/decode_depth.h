// SPDX-License-Identifier: Apache-2.0
// Decodes one depth sample on the CPU: its 1/Z, or why it has none. The kernels of
// sweep/column_kernels.cpp and prepare_columns.comp do the same for many samples at a time.
#pragma once

#include "frame/depth.h"

namespace viewloom {

enum class DepthSampleKind {
  kSurface,    // nearer than infinity
  kSky,        // infinitely far: a surface at 1/Z = 0
  kNoSurface,  // the invalid value, or metric 0
  kBad,        // NaN, negative (-inf, too), or nearer than a nanometre: no surface
};

struct DecodedDepth {
  DepthSampleKind kind = DepthSampleKind::kBad;
  float inv_z = 0;  // 1/m; 0 unless kSurface

  bool isSurface() const {
    return kind == DepthSampleKind::kSurface || kind == DepthSampleKind::kSky;
  }
};

// Decodes a sample as stored, U16 as 0..65535. `ray_length` is the length of the ray through the
// pixel for each metre along the view axis. It matters for ray distances only.
//
//   sample              PLANAR, RAY_DISTANCE    DISPARITY       WINDOW
//   the invalid value   no surface, or the sky where it is far
//   NaN                 bad                     bad             bad
//   -inf                bad                     bad             bad (reversed depth, too)
//   below 0 once read   bad                     bad             bad: behind infinity
//   0 or -0 once read   no surface              the sky         the sky
//   below 1e-9 m        bad (> 1e9 1/m)         bad             bad
//   +inf                the sky                 bad             bad
//
// A scale below 0 is applied first: -inf metres times -1 is the sky. Subnormal values may count as
// 0, as devices flush them.
inline DecodedDepth decodeDepth(const DepthCoefficients& depth, float sample,
                                float ray_length = 1) {
  if (depth.has_invalid != 0 && sample == depth.invalid_value) {
    return {.kind =
                depth.invalid_is_far != 0 ? DepthSampleKind::kSky : DepthSampleKind::kNoSurface};
  }
  const float value = (sample - depth.origin) * depth.scale + depth.offset;
  if (!(value >= 0)) return {};
  if (depth.reciprocal != 0 && value == 0) return {.kind = DepthSampleKind::kNoSurface};
  float inv_z = depth.reciprocal != 0 ? 1 / value : value;
  if (depth.ray_distance != 0) inv_z *= ray_length;
  if (!(inv_z <= depth.inv_z_max)) return {};
  if (inv_z == 0) return {.kind = DepthSampleKind::kSky};
  return {.kind = DepthSampleKind::kSurface, .inv_z = inv_z};
}

}  // namespace viewloom
