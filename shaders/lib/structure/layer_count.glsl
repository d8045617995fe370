// SPDX-License-Identifier: Apache-2.0
// How many layers the structure has: loops over whole columns are unrolled.
#ifndef VIEWLOOM_LIB_STRUCTURE_LAYER_COUNT_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_LAYER_COUNT_GLSL_

#include "shared/kernel_constants.h"

layout(constant_id = kIdLayerCount) const uint kLayerCount = 2u;

#endif  // VIEWLOOM_LIB_STRUCTURE_LAYER_COUNT_GLSL_
