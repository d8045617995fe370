// SPDX-License-Identifier: Apache-2.0
// Parameters of all rays of a walk.
#ifndef VIEWLOOM_LIB_RAYS_EXTRAS_GLSL_
#define VIEWLOOM_LIB_RAYS_EXTRAS_GLSL_

#include "shared/trace_abi.h"

layout(set = 0, binding = kBindingExtras, scalar) uniform Extras {
  TraceExtras extras;
};

#endif  // VIEWLOOM_LIB_RAYS_EXTRAS_GLSL_
