// SPDX-License-Identifier: Apache-2.0
// From depth to the codes that RGBD displays take: linear in 1/Z.
#ifndef VIEWLOOM_SHADERS_SHARED_DEPTH_SCALE_H_
#define VIEWLOOM_SHADERS_SHARED_DEPTH_SCALE_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

struct DepthScale {
  float inv_z_of_zero;    // 1/Z of code 0, 1/m
  float codes_per_inv_z;  // m; negative where code 0 is the nearest
  float code_max;         // 255 or 65535
};

// The nearest code, 0..code_max. `inv_z`: 1/Z of the view, 1/m; 0 is infinitely far.
VIEWLOOM_ABI_FUNCTION uint depthCode(float inv_z, DepthScale scale) {
  const float code = (inv_z - scale.inv_z_of_zero) * scale.codes_per_inv_z;
  const float most = code < scale.code_max ? code : scale.code_max;
  return uint((most > 0.0f ? most : 0.0f) + 0.5f);
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_DEPTH_SCALE_H_
