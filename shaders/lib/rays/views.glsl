// SPDX-License-Identifier: Apache-2.0
// The tiles of an atlas as a walk sees them.
#ifndef VIEWLOOM_LIB_RAYS_VIEWS_GLSL_
#define VIEWLOOM_LIB_RAYS_VIEWS_GLSL_

#include "shared/trace_abi.h"

layout(set = 0, binding = kBindingViews, scalar) readonly buffer Views {
  ViewParams views[];
};

#endif  // VIEWLOOM_LIB_RAYS_VIEWS_GLSL_
