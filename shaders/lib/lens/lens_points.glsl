// SPDX-License-Identifier: Apache-2.0
// Points of the lens: those of a sample of each px of the pattern, then those of the next sample.
#ifndef VIEWLOOM_LIB_LENS_LENS_POINTS_GLSL_
#define VIEWLOOM_LIB_LENS_LENS_POINTS_GLSL_

#include "shared/lens_abi.h"

layout(set = 0, binding = kBindingLensPoints, scalar) readonly buffer LensPoints {
  vec2 lens_points[];
};

#endif  // VIEWLOOM_LIB_LENS_LENS_POINTS_GLSL_
