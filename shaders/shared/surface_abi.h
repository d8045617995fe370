// SPDX-License-Identifier: Apache-2.0
// How a px of a layer mirrors, as it lies on the device.
#ifndef VIEWLOOM_SHADERS_SHARED_SURFACE_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_SURFACE_ABI_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

struct SurfaceTexel {
  // Where it faces, in the source's camera: proto PLANE_ENCODING_OCT16, u in the low half.
  uint normal;
  uint light;  // what it mirrors head on, 0..255 of red, green and blue from below; roughness above
};

// There the surface's own slope counts.
VIEWLOOM_ABI_CONST uint kNoNormal = 0u;

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_SURFACE_ABI_H_
