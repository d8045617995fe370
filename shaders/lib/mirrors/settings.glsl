// SPDX-License-Identifier: Apache-2.0
// Settings of the kernels of reflections: the display, and the structure that they work on. They
// lead between the camera of a walk and that of the first one, in which reflected rays are told.
#ifndef VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_
#define VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_

#include "shared/reflection_abi.h"

layout(set = 0, binding = kBindingReflection, scalar) uniform Settings {
  ReflectionSettings settings;
};

// Axes of the normals that the walk's source gives.
mat3 normalAxes() {
  return mat3(settings.source_right, settings.source_down, settings.source_forward);
}

vec3 directionFromFirst(vec3 direction) {
  return settings.first_right * direction.x + settings.first_down * direction.y +
         settings.first_forward * direction.z;
}

vec3 pointFromFirst(vec3 point_m) {
  return directionFromFirst(point_m) + settings.first_place;
}

vec3 directionToFirst(vec3 direction) {
  return vec3(dot(settings.first_right, direction), dot(settings.first_down, direction),
              dot(settings.first_forward, direction));
}

vec3 pointToFirst(vec3 point_m) {
  return directionToFirst(point_m - settings.first_place);
}

#endif  // VIEWLOOM_LIB_MIRRORS_SETTINGS_GLSL_
