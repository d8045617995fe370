// SPDX-License-Identifier: Apache-2.0
// What the kernels of reflections are told of a display and of the structure they work on.
#ifndef VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_
#define VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_

#include "shared/reflection_abi.h"

layout(set = 0, binding = kBindingReflection, scalar) uniform Settings {
  ReflectionSettings settings;
};

#endif  // VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_
