// SPDX-License-Identifier: Apache-2.0
// Between the camera of a walk and that of the first one, in which reflected rays are told.
#ifndef VIEWLOOM_LIB_MIRRORS_FIRST_CAMERA_GLSL_
#define VIEWLOOM_LIB_MIRRORS_FIRST_CAMERA_GLSL_

#include "lib/mirrors/settings.glsl"
#include "shared/reflection_abi.h"

// Of the normals that the walk's source gives.
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

#endif  // VIEWLOOM_LIB_MIRRORS_FIRST_CAMERA_GLSL_
